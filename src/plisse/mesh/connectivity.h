#pragma once

#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// Relations of a triangle mesh, constant once built. Stored:
///   edges        unique, lower vertex first, sorted
///   face_edges   edge k of a face joins its corners k and k+1 (mod 3)
///   edge_faces   the one or two faces of an edge, -1 where there is none (of a non-manifold edge, the first two)
///   opposite     the corner of each of those faces that is not on the edge, -1 where there is none
///   vertex_faces faces around a vertex, ascending
class Connectivity {
public:
    Connectivity() = default;
    Connectivity(int vertex_count, std::span<const Face> faces);

    int vertex_count() const { return static_cast<int>(vertex_faces_offsets_.size()) - 1; }
    int edge_count() const { return static_cast<int>(edges_.size()); }
    int face_count() const { return static_cast<int>(face_edges_.size()); }

    const std::vector<Edge>& edges() const { return edges_; }
    const std::vector<std::array<int, 3>>& face_edges() const { return face_edges_; }
    const std::vector<std::array<int, 2>>& edge_faces() const { return edge_faces_; }
    const std::vector<std::array<int, 2>>& opposite() const { return opposite_; }
    std::span<const int> vertex_faces(int vertex) const {
        const auto v = static_cast<std::size_t>(vertex);
        return std::span(vertex_faces_)
            .subspan(static_cast<std::size_t>(vertex_faces_offsets_[v]),
                     static_cast<std::size_t>(vertex_faces_offsets_[v + 1] - vertex_faces_offsets_[v]));
    }
    bool is_boundary_edge(int edge) const { return edge_faces_[static_cast<std::size_t>(edge)][1] < 0; }
    /// Edges with more than two faces, ascending.
    const std::vector<int>& non_manifold_edges() const { return non_manifold_edges_; }

private:
    std::vector<Edge> edges_;
    std::vector<std::array<int, 3>> face_edges_;
    std::vector<std::array<int, 2>> edge_faces_;
    std::vector<std::array<int, 2>> opposite_;
    std::vector<int> vertex_faces_;
    std::vector<int> vertex_faces_offsets_{0};
    std::vector<int> non_manifold_edges_;
};

/// Closed chains of boundary vertices, each walked with the surface on its left, ordered by their lowest vertex, which
/// comes first. Of a manifold, consistently oriented mesh.
std::vector<std::vector<int>> boundary_loops(const Connectivity& connectivity, std::span<const Face> faces);

/// Component number of every vertex, by order of lowest vertex; -1 for vertices no face uses.
std::vector<int> components(int vertex_count, std::span<const Face> faces);

} // namespace plisse
