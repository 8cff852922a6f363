#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <plisse/base/random.h>
#include <plisse/linalg/newton_system.h>

namespace plisse {

/// A grid of vertices coupled with the eight around them and with a few far away, as contact does.
struct Grid {
    int side;
    std::vector<Edge> pairs, far;

    Grid(int vertices_a_side, int far_pairs, std::uint64_t seed) : side(vertices_a_side) {
        const auto vertex = [&](int i, int j) { return i * side + j; };
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j)
                for (const auto& [di, dj] : {std::pair{0, 1}, {1, 0}, {1, 1}, {1, -1}})
                    if (i + di < side && j + dj >= 0 && j + dj < side)
                        pairs.push_back({vertex(i, j), vertex(i + di, j + dj)});
        Random random(seed);
        while (static_cast<int>(far.size()) < far_pairs) {
            const int a = static_cast<int>(random.uniform(0, side * side));
            const int b = static_cast<int>(random.uniform(0, side * side));
            if (a != b)
                far.push_back({a, b});
        }
    }
    int vertex_count() const { return side * side; }

    NewtonSystem system() const { return {std::vector<std::uint8_t>(3 * at(vertex_count()), 0), pairs}; }

    /// Random springs along all pairs, and a little on the diagonal.
    void assemble(NewtonSystem& system, std::uint64_t seed) const {
        Random random(seed);
        system.begin(far);
        for (int v = 0; v < vertex_count(); ++v)
            system.add_block(v, v, 0.01 * Mat3::Identity());
        for (const auto* list : {&pairs, &far})
            for (const Edge& pair : *list) {
                Mat3 a;
                for (double& entry : a.reshaped())
                    entry = random.uniform(-1, 1);
                const Mat3 spring = a * a.transpose();
                Eigen::Matrix<double, 6, 6> element;
                element << spring, -spring, -spring, spring;
                system.add(pair, element);
            }
    }

    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
};

inline VecX ramp(int size) {
    return VecX::LinSpaced(size, -1, 2);
}

} // namespace plisse
