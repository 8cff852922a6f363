#pragma once

#include <cmath>
#include <vector>

#include <plisse/base/random.h>
#include <plisse/contact/collision_mesh.h>
#include <plisse/linalg/newton_system.h>

namespace plisse {

/// Several surfaces in one mesh, with numbered parts.
struct Scene {
    Positions x{3, 0};
    std::vector<Face> faces;
    std::vector<int> part;
    std::vector<std::uint8_t> obstacle;

    void append(const Positions& points, const std::vector<Face>& new_faces, bool is_obstacle) {
        const int base = static_cast<int>(x.cols());
        x.conservativeResize(3, base + points.cols());
        x.rightCols(points.cols()) = points;
        for (const Face& f : new_faces)
            faces.push_back({f[0] + base, f[1] + base, f[2] + base});
        part.resize(static_cast<std::size_t>(x.cols()), static_cast<int>(obstacle.size()));
        obstacle.push_back(is_obstacle);
    }

    /// A grid of n x n cells with alternating diagonals; point(u, v) maps [0, 1]^2 to space.
    template <typename Point>
    void append_sheet(int n, const Point& point, bool is_obstacle = false) {
        Positions points(3, (n + 1) * (n + 1));
        std::vector<Face> sheet;
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j)
                points.col(i * (n + 1) + j) = point(static_cast<double>(i) / n, static_cast<double>(j) / n);
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const int a = i * (n + 1) + j, b = a + n + 1, c = b + 1, d = a + 1;
                if ((i + j) % 2 == 0) {
                    sheet.push_back({a, b, c});
                    sheet.push_back({a, c, d});
                } else {
                    sheet.push_back({a, b, d});
                    sheet.push_back({b, c, d});
                }
            }
        append(points, sheet, is_obstacle);
    }

    /// Leaves of n x n cells at one spine, every second turned the other way; point(leaf, u, v), the spine at u = 0.
    template <typename Point>
    void append_book(int leaves, int n, const Point& point) {
        Positions points(3, (n + 1) * (leaves * n + 1));
        std::vector<Face> book;
        const auto at = [&](int leaf, int i, int j) { return (i == 0 ? 0 : leaf * n + i) * (n + 1) + j; };
        for (int leaf = 0; leaf < leaves; ++leaf)
            for (int i = leaf == 0 ? 0 : 1; i <= n; ++i)
                for (int j = 0; j <= n; ++j)
                    points.col(at(leaf, i, j)) = point(leaf, static_cast<double>(i) / n, static_cast<double>(j) / n);
        for (int leaf = 0; leaf < leaves; ++leaf)
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const int a = at(leaf, i, j), b = at(leaf, i + 1, j), c = at(leaf, i + 1, j + 1),
                              d = at(leaf, i, j + 1);
                    book.push_back(leaf % 2 == 0 ? Face{a, b, c} : Face{a, c, b});
                    book.push_back(leaf % 2 == 0 ? Face{a, c, d} : Face{a, d, c});
                }
        append(points, book, false);
    }

    CollisionMesh mesh(const Positions& rest) const { return {rest, faces, part, obstacle}; }
    CollisionMesh mesh() const { return mesh(x); }
};

inline Positions jittered(const Positions& x, Random& random, double size) {
    Positions result = x;
    for (int i = 0; i < result.size(); ++i)
        result(i) += random.uniform(-size, size);
    return result;
}

} // namespace plisse
