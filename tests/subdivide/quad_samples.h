#pragma once

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>

#include <Eigen/Geometry>

#include <plisse/subdivide/subdivision_levels.h>

namespace plisse {

/// Cells of a grid that are `wanted`, with the vertices they use, at unit distance in the plane z = 0.
inline QuadMesh grid_cells(int nx, int ny, const std::function<bool(int, int)>& wanted) {
    QuadMesh mesh;
    std::map<std::array<int, 2>, int> numbers;
    std::vector<Vec3> points;
    const auto vertex = [&](int i, int j) {
        const auto [place, is_new] = numbers.try_emplace({i, j}, static_cast<int>(points.size()));
        if (is_new)
            points.emplace_back(i, j, 0);
        return place->second;
    };
    for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i)
            if (wanted(i, j))
                mesh.faces.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    mesh.positions.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t v = 0; v < points.size(); ++v)
        mesh.positions.col(static_cast<Eigen::Index>(v)) = points[v];
    return mesh;
}

inline QuadMesh flat_grid(int nx, int ny) {
    return grid_cells(nx, ny, [](int, int) { return true; });
}

/// n x n cells without k x k at the corner of large coordinates.
inline QuadMesh l_shape(int n, int k) {
    return grid_cells(n, n, [&](int i, int j) { return i < n - k || j < n - k; });
}

/// n faces around vertex 0, bent upward.
inline QuadMesh fan(int n) {
    QuadMesh mesh;
    mesh.positions.resize(3, 2 * n + 1);
    mesh.positions.col(0).setZero();
    for (int k = 0; k < n; ++k) {
        const auto place = [&](double turns, double r) {
            const double a = 2 * std::numbers::pi * turns / n;
            return Vec3(r * std::cos(a), r * std::sin(a), 0.1 * r * r * std::cos(2 * a));
        };
        mesh.positions.col(1 + 2 * k) = place(k, 1);
        mesh.positions.col(2 + 2 * k) = place(k + 0.5, 1.3);
        mesh.faces.push_back({0, 1 + 2 * k, 2 + 2 * k, 1 + (2 * k + 2) % (2 * n)});
    }
    return mesh;
}

/// The surface of unit cubes: closed, valence 3 at outer corners, 5 at inner ones, often beside each other.
inline QuadMesh cubes(const std::set<std::array<int, 3>>& cells) {
    QuadMesh mesh;
    std::map<std::array<int, 3>, int> numbers;
    std::vector<Vec3> points;
    for (const std::array<int, 3>& cell : cells)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (int side : {0, 1}) {
                std::array<int, 3> other = cell;
                other[axis] += 2 * side - 1;
                if (cells.contains(other))
                    continue;
                Quad quad{};
                for (std::size_t k = 0; k < 4; ++k) {
                    std::array<int, 3> corner = cell;
                    corner[axis] += side;
                    corner[(axis + 1) % 3] += k == 1 || k == 2 ? 1 : 0;
                    corner[(axis + 2) % 3] += k >= 2 ? 1 : 0;
                    const auto [place, is_new] = numbers.try_emplace(corner, static_cast<int>(points.size()));
                    if (is_new)
                        points.emplace_back(corner[0], corner[1], corner[2]);
                    quad[side == 1 ? k : 3 - k] = place->second;
                }
                mesh.faces.push_back(quad);
            }
    mesh.positions.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t v = 0; v < points.size(); ++v)
        mesh.positions.col(static_cast<Eigen::Index>(v)) = points[v];
    return mesh;
}

struct QuadSample {
    std::string name;
    QuadMesh mesh;
    bool ordinary; ///< all vertices are
};

inline std::vector<QuadSample> quad_samples() {
    std::vector<QuadSample> samples = {
        {"grid", flat_grid(4, 3), true},
        {"one face", flat_grid(1, 1), true},
        {"strip", flat_grid(3, 1), true},
        {"L", l_shape(4, 1), true},
        {"wide L", l_shape(4, 2), true},
        {"holes", grid_cells(7, 4, [](int i, int j) { return (i != 1 && i != 2 && i < 4) || (j != 1 && j != 2); }),
         true},
        {"slot", grid_cells(6, 4, [](int i, int j) { return i < 2 || i > 3 || j < 2; }), true},
        {"inner corners", cubes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), false},
    };
    for (int n : {3, 5, 6, 7, 8})
        samples.push_back({"valence " + std::to_string(n), fan(n), false});
    return samples;
}

inline Positions random_positions(int count, unsigned seed = 1) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> number(-1, 1);
    return Positions::NullaryExpr(3, count, [&] { return number(generator); });
}

/// A field of stencils applied to control points.
inline Positions evaluated(const Eigen::MatrixXd& weights, std::span<const int> points, const Positions& x) {
    Positions gathered(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t k = 0; k < points.size(); ++k)
        gathered.col(static_cast<Eigen::Index>(k)) = x.col(points[k]);
    return gathered * weights;
}

inline double largest(const VertexWeights& m) {
    return m.nonZeros() == 0 ? 0 : Eigen::Map<const VecX>(m.valuePtr(), m.nonZeros()).cwiseAbs().maxCoeff();
}

inline VertexWeights identity(Eigen::Index size) {
    VertexWeights result(size, size);
    result.setIdentity();
    return result;
}

} // namespace plisse
