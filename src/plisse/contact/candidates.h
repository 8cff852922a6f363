#pragma once

#include <vector>

#include <plisse/contact/collision_mesh.h>
#include <plisse/geometry/ccd.h>
#include <plisse/spatial/box_tree.h>

namespace plisse {

/// Pairs of primitives that may come near each other while every vertex stays within a box of its own, its region.
/// Boxes are convex, so straight motion from one place in its region to another stays inside. Two primitives that are
/// not a candidate stay further apart than the contact's reach.
///
/// Pairs never share a vertex, are never both on obstacles, and lie within one part only if `self`.
class Candidates {
public:
    /// mesh must outlive the object. reach: distance below which surfaces may repel, m.
    Candidates(const CollisionMesh& mesh, double reach, bool self);

    /// Drops all regions, so that the next search depends on its arguments alone.
    void forget() { regions_.clear(); }
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
    std::array<int, 2> primitives(StencilKind kind, int i) const {
        auto [first, second] = of(kind).found.pairs()[static_cast<std::size_t>(i)];
        if (kind == StencilKind::point_triangle)
            first = mesh_.vertices[static_cast<std::size_t>(first)];
        return {first, second};
    }
    /// The pair's distance at rest, m, cut off at twice the reach.
    double rest_distance(StencilKind kind, int i) const;

    /// Whether most pairs have moved so far since they were measured that their bounds are worth little.
    bool have_drifted(const Positions& x) const;
    /// Measures all pairs at x; a search does so at its own x.
    void measure(const Positions& x);

    /// How far primitives may be, anywhere on the straight way from x to y, from where they were last measured.
    struct Drift {
        std::vector<double> of_vertex, of_edge, of_face; ///< m
    };
    void find_drift(const Positions& x, const Positions& y, Drift& drift) const;
    /// A lower bound, m, on the distance of candidate i at any place the drift allows.
    double least_distance(StencilKind kind, int i, const Drift& drift) const {
        const auto [first, second] = primitives(kind, i);
        const bool edges = kind == StencilKind::edge_edge;
        const double moved = (edges ? drift.of_edge : drift.of_vertex)[static_cast<std::size_t>(first)] +
                             (edges ? drift.of_edge : drift.of_face)[static_cast<std::size_t>(second)];
        return of(kind).distances[static_cast<std::size_t>(i)] - moved;
    }

private:
    struct Ball {
        Vec3 center;
        double radius; ///< m
    };
    struct Pairs {
        OverlapPairs found;
        std::vector<double> distances; ///< at measured_at_, or of the boxes there, m
    };

    const Pairs& of(StencilKind kind) const {
        return kind == StencilKind::point_triangle ? vertex_faces_ : edge_edges_;
    }
    void set_regions(const Positions& x, const Positions* d, double share);
    bool find_pairs(std::size_t most);
    void measure(StencilKind kind, Pairs& pairs) const;
    bool may_meet(int vertex, int other) const;
    /// Whether two primitives, the first of `First` vertices, surely stay further apart than the reach.
    template <int First>
    bool stay_apart(const std::array<int, 4>& vertices) const;
    static Ball ball_around(const Box& box);

    const CollisionMesh& mesh_;
    double reach_;
    bool self_;
    double slack_;
    std::vector<Box> regions_;                                ///< per vertex; empty before the first search
    std::vector<Ball> balls_;                                 ///< about the regions
    std::vector<Box> vertex_boxes_, edge_boxes_, face_boxes_; ///< of mesh.vertices, edges and faces
    BoxTree vertex_tree_, edge_tree_, face_tree_;
    Positions measured_at_{3, 0};
    Pairs vertex_faces_, edge_edges_;
};

/// The points of a candidate.
inline Stencil gather(const Positions& x, const std::array<int, 4>& vertices) {
    Stencil stencil;
    for (int i = 0; i < 4; ++i)
        stencil.col(i) = x.col(vertices[static_cast<std::size_t>(i)]);
    return stencil;
}

/// The squared distance of the boxes that two primitives sweep between two stencils: a lower bound on their distance
/// at any moment.
double squared_sweep_distance(StencilKind kind, const Stencil& from, const Stencil& to);

} // namespace plisse
