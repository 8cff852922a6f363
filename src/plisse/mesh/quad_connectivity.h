#pragma once

#include <span>
#include <vector>

#include <plisse/mesh/quad_mesh.h>

namespace plisse {

/// Relations of a manifold, consistently oriented mesh of quadrilaterals, constant once built. A side h = 4 f + k is
/// the edge of face f from its corner k to its corner k + 1 (mod 4), with the face on its left. Stored:
///   twin        the side of the other face at the same edge, -1 on the boundary
///   edge        number of the edge of a side; edges are numbered by their first side
///   edge_sides  the first side of every edge
///   start       per vertex: a side that leaves it; on the boundary the one without a twin. -1: no face
class QuadConnectivity {
public:
    QuadConnectivity(int vertex_count, std::span<const Quad> faces);

    int vertex_count() const { return static_cast<int>(start_.size()); }
    int edge_count() const { return static_cast<int>(edge_sides_.size()); }
    int side_count() const { return static_cast<int>(twin_.size()); }

    static int next(int side) { return (side & ~3) | ((side + 1) & 3); }
    static int previous(int side) { return (side & ~3) | ((side + 3) & 3); }

    int from(int side) const { return from_[static_cast<std::size_t>(side)]; }
    int to(int side) const { return from(next(side)); }
    int twin(int side) const { return twin_[static_cast<std::size_t>(side)]; }
    int edge(int side) const { return edge_[static_cast<std::size_t>(side)]; }
    int edge_side(int edge) const { return edge_sides_[static_cast<std::size_t>(edge)]; }
    /// The next side that leaves the same vertex, counter-clockwise; -1 past the last face of a boundary vertex.
    int rotated(int side) const { return twin(previous(side)); }

    bool is_boundary_vertex(int vertex) const;
    /// The sides that leave a vertex, counter-clockwise, one of each of its faces.
    std::vector<int> star(int vertex) const;

private:
    std::vector<int> from_, twin_, edge_, edge_sides_, start_;
};

} // namespace plisse
