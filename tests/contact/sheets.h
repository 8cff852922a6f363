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

    CollisionMesh mesh(const Positions& rest) const { return {rest, faces, part, obstacle}; }
    CollisionMesh mesh() const { return mesh(x); }
};

inline Positions jittered(const Positions& x, Random& random, double size) {
    Positions result = x;
    for (int i = 0; i < result.size(); ++i)
        result(i) += random.uniform(-size, size);
    return result;
}

inline Eigen::MatrixXd dense(const NewtonSystem& system) {
    const int n = 3 * system.row_count();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    for (int column = 0; column < system.row_count(); ++column) {
        const int begin = system.column_starts()[static_cast<std::size_t>(column)];
        const int end = system.column_starts()[static_cast<std::size_t>(column) + 1];
        for (int k = begin; k < end; ++k)
            for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b) {
                    const int row = 3 * system.block_rows()[static_cast<std::size_t>(k)] + a, to = 3 * column + b;
                    const double value = system.values()[static_cast<std::size_t>(9 * begin + b * 3 * (end - begin) +
                                                                                  3 * (k - begin) + a)];
                    matrix(row, to) = value;
                    matrix(to, row) = value;
                }
    }
    return matrix;
}

} // namespace plisse
