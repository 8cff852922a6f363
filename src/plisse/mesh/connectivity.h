#pragma once

#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// Relations of a triangle mesh, constant once built. Stored:
///   edges        unique, lower vertex first, sorted
///   face_edges   edge k of a face joins its corners k and k+1 (mod 3)
///   edge_faces   the faces of an edge, ascending: one on a boundary, two within a sheet, more where sheets are joined
///   opposite     the corner of each of those faces that is not on the edge
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
    std::span<const int> edge_faces(int edge) const { return row(edge_faces_, edge_offsets_, edge); }
    std::span<const int> opposite(int edge) const { return row(opposite_, edge_offsets_, edge); }
    std::span<const int> vertex_faces(int vertex) const { return row(vertex_faces_, vertex_faces_offsets_, vertex); }
    bool is_boundary_edge(int edge) const { return edge_faces(edge).size() == 1; }
    /// Whether the edge bounds sheets: it does not have two faces.
    bool is_curve_edge(int edge) const { return edge_faces(edge).size() != 2; }
    /// Edges with more than two faces, ascending.
    std::vector<int> non_manifold_edges() const;

private:
    static std::span<const int> row(const std::vector<int>& items, const std::vector<int>& offsets, int number) {
        const auto n = static_cast<std::size_t>(number);
        return std::span(items).subspan(static_cast<std::size_t>(offsets[n]),
                                        static_cast<std::size_t>(offsets[n + 1] - offsets[n]));
    }

    std::vector<Edge> edges_;
    std::vector<std::array<int, 3>> face_edges_;
    std::vector<int> edge_faces_, opposite_;
    std::vector<int> edge_offsets_;
    std::vector<int> vertex_faces_;
    std::vector<int> vertex_faces_offsets_{0};
};

/// Closed chains of boundary vertices, each walked with the surface on its left, ordered by their lowest vertex, which
/// comes first. Of a manifold, consistently oriented mesh.
std::vector<std::vector<int>> boundary_loops(const Connectivity& connectivity, std::span<const Face> faces);

/// Vertices of the connected pieces of the boundary, ascending, ordered by their lowest vertex: the loops of a
/// manifold. Where a sheet ends in another one its boundary may be an open chain, or branch.
std::vector<std::vector<int>> boundary_pieces(const Connectivity& connectivity);

/// Component number of every vertex, by order of lowest vertex; -1 for vertices no face uses.
std::vector<int> components(int vertex_count, std::span<const Face> faces);

} // namespace plisse
