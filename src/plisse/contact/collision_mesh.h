#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <plisse/base/types.h>
#include <plisse/geometry/ccd.h>
#include <plisse/mesh/connectivity.h>

namespace plisse {

/// The surfaces that may touch, on one level: points, edges and triangles of all bodies and obstacles together.
struct CollisionMesh {
    Positions rest; ///< m; distances at rest decide how far apart a pair begins to repel
    std::vector<Face> faces;
    Connectivity connectivity;
    std::vector<Edge> edges;            ///< all edges of the faces, lower vertex first, sorted
    std::vector<int> vertices;          ///< vertices that some face uses, ascending
    std::vector<int> part;              ///< per vertex: number of its body or obstacle
    std::vector<std::uint8_t> obstacle; ///< per part: 1 for an obstacle (pairs of two obstacles never interact)
    std::vector<double> vertex_area, edge_area, face_area; ///< m^2 at rest: thirds of the adjacent faces' areas; per
                                                           ///< vertex, per edge, per face
    std::vector<double> largest_vertex_area;               ///< per part

    bool has_corner(int face, int vertex) const {
        const auto& [a, b, c] = faces[static_cast<std::size_t>(face)];
        return a == vertex || b == vertex || c == vertex;
    }

    /// Vertices of a vertex and a face, or of two edges, in the order of a stencil.
    std::array<int, 4> stencil_vertices(StencilKind kind, const std::array<int, 2>& primitives) const {
        const auto first = static_cast<std::size_t>(primitives[0]), second = static_cast<std::size_t>(primitives[1]);
        if (kind == StencilKind::point_triangle) {
            const auto& [a, b, c] = faces[second];
            return {primitives[0], a, b, c};
        }
        const Edge &a = edges[first], &b = edges[second];
        return {a[0], a[1], b[0], b[1]};
    }

    CollisionMesh() = default;
    CollisionMesh(Positions rest, std::vector<Face> faces, std::vector<int> part, std::vector<std::uint8_t> obstacle);
};

} // namespace plisse
