#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse::shapes {

/// A grid of columns by rows cells, its vertices at place(u, v), u and v in [0, 1]; its front looks along dx/du x
/// dx/dv.
template <typename Place>
TriangleMesh grid(int columns, int rows, const Place& place) {
    TriangleMesh mesh;
    mesh.positions.resize(3, (columns + 1) * (rows + 1));
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            mesh.positions.col(j * (columns + 1) + i) =
                place(static_cast<double>(i) / columns, static_cast<double>(j) / rows);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const int a = j * (columns + 1) + i;
            const int b = a + columns + 1;
            mesh.faces.push_back({a, a + 1, b + 1});
            mesh.faces.push_back({a, b + 1, b});
        }
    return mesh;
}

/// A closed-looking sphere about the origin, axis y, front outside; its seam and poles are not welded.
inline TriangleMesh sphere(double radius, int rings) {
    return grid(2 * rings, rings, [&](double u, double v) {
        const double around = 2 * std::numbers::pi * u;
        const double down = std::numbers::pi * (1 - v);
        return Vec3{radius * std::sin(down) * std::sin(around), radius * std::cos(down),
                    radius * std::sin(down) * std::cos(around)};
    });
}

/// A square of side 2 in the plane z = 0, front towards +z.
inline TriangleMesh square(int cells) {
    return grid(cells, cells, [](double u, double v) { return Vec3{2 * u - 1, 2 * v - 1, 0}; });
}

/// A cube of side 2 about the origin, front outside, with shared corners.
inline TriangleMesh cube() {
    TriangleMesh mesh;
    mesh.positions.resize(3, 8);
    for (int i = 0; i < 8; ++i)
        mesh.positions.col(i) = Vec3{i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0};
    mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                  {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

/// Puts `other` beside the faces of `mesh`.
inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
    const int offset = mesh.vertex_count();
    Positions positions(3, offset + other.vertex_count());
    positions << mesh.positions, other.positions;
    mesh.positions = positions;
    for (const Face& face : other.faces)
        mesh.faces.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
}

} // namespace plisse::shapes
