#pragma once

#include <optional>
#include <vector>

#include <plisse/decimate/patch.h>
#include <plisse/decimate/triangle_distance.h>
#include <plisse/decimate/vertex_state.h>
#include <plisse/spatial/hash_grid.h>

namespace plisse {

/// Keeps collapses from bringing new intersections or too small gaps. Holds references: the caller's positions, faces,
/// shapes and vertices are those at the moment of the call.
class Clearance {
public:
    enum class Verdict { clear, intersection, gap };

    struct Surface {
        const Positions& rest;                    ///< by vertex id
        const DynamicFaces& faces;                ///< before the collapse
        const std::vector<FaceShape>& shapes;     ///< by face id
        const std::vector<VertexState>& vertices; ///< by id
        const std::vector<bool>& obstacle_parts;  ///< two faces of obstacles may intersect
    };

    /// least_gap: in edge lengths.
    Clearance(const Surface& surface, double least_gap);

    /// Judges the faces after a collapse against all others. Pairs that intersected or were nearer before may stay so.
    Verdict check(const Patch& patch);
    /// Tells that the collapse was made.
    void apply(const Patch& patch);

private:
    void build_grid();
    Triangle corners(const Face& face) const {
        return {surface_.rest.col(face[0]), surface_.rest.col(face[1]), surface_.rest.col(face[2])};
    }
    bool both_obstacles(int vertex, int face) const;
    bool newly_intersect(const Patch& patch, std::size_t after, int other) const;

    bool merged_star_intersects(const Patch& patch);
    bool ring_star_intersects(const Patch& patch, int vertex);
    bool star_is_graph(int vertex) const;
    Verdict check_unconnected(const Patch& patch);
    Verdict check_pair(const Patch& patch, std::size_t after, int other, double gap) const;
    double distance_before_squared(const Patch& patch, int other) const;

    Surface surface_;
    double least_gap_;
    std::optional<HashGrid> grid_;
    int faces_left_ = 0, faces_at_build_ = 0;

    struct StarFace {
        const Face* face;
        const Vec3* normal;
    };
    std::vector<StarFace> star_;
    std::vector<int> others_;
    std::vector<Triangle> after_;
    std::vector<Box> after_boxes_;
};

} // namespace plisse
