#pragma once

#include <vector>

#include <plisse/contact/collision_mesh.h>
#include <plisse/geometry/ccd.h>
#include <plisse/spatial/box_tree.h>

namespace plisse {

/// Pairs of primitives that may come near each other while every vertex stays within a box of its own, its region.
/// Boxes are convex, so straight motion from one place in its region to another stays inside. Two primitives that are
/// not a candidate stay further apart than the contact distance.
///
/// Pairs never share a vertex, are never both on obstacles, and lie within one part only if `self`.
class Candidates {
public:
    /// mesh must outlive the object. distance: the contact distance, m.
    Candidates(const CollisionMesh& mesh, double distance, bool self);

    /// Whether each vertex is within its region.
    bool contain(const Positions& x) const;

    /// Finds the pairs for regions around x.
    void find_around(const Positions& x);

    /// Finds the pairs for regions around the way from x to x + share * d, and returns the share: the largest of most,
    /// most / 2, most / 4, ... for which the pairs are no more than a multiple of the vertices or of the pairs around
    /// x. So a thin sheet that falls far fits in memory.
    double find_along(const Positions& x, const Positions& d, double most);

    int size(StencilKind kind) const { return static_cast<int>(of(kind).found.pairs().size()); }
    /// Vertices of candidate i in the order of a stencil.
    std::array<int, 4> vertices(StencilKind kind, int i) const;
    /// Vertex and face, or edge and edge.
    const std::array<int, 2>& primitives(StencilKind kind, int i) const {
        return of(kind).found.pairs()[static_cast<std::size_t>(i)];
    }
    /// The pair's distance at rest, m, cut off at twice the contact distance.
    double rest_distance(StencilKind kind, int i) const { return of(kind).rest_distances[static_cast<std::size_t>(i)]; }

private:
    struct Pairs {
        OverlapPairs found;
        std::vector<double> rest_distances;
    };

    const Pairs& of(StencilKind kind) const {
        return kind == StencilKind::point_triangle ? vertex_faces_ : edge_edges_;
    }
    void set_regions(const Positions& x, const Positions* d, double share);
    bool find_pairs(std::size_t most);
    void find_rest_distances(StencilKind kind, Pairs& pairs) const;
    bool may_meet(int vertex, int other) const;

    const CollisionMesh& mesh_;
    double distance_;
    bool self_;
    double slack_;
    std::vector<Box> regions_; ///< per vertex; empty before the first search
    std::vector<Box> vertex_boxes_, edge_boxes_, face_boxes_;
    BoxTree edge_tree_, face_tree_;
    Pairs vertex_faces_, edge_edges_;
};

/// The points of a candidate.
inline Stencil gather(const Positions& x, const std::array<int, 4>& vertices) {
    Stencil stencil;
    for (int i = 0; i < 4; ++i)
        stencil.col(i) = x.col(vertices[static_cast<std::size_t>(i)]);
    return stencil;
}

/// A lower bound on the squared distance of the two primitives of a stencil: that of their boxes.
double squared_box_distance(StencilKind kind, const Stencil& x);

} // namespace plisse
