#pragma once

#include <vector>

#include <plisse/base/types.h>
#include <plisse/transfer/prolongation.h>

namespace plisse {

/// One edge collapse: vertices i and j became the fresh vertex k = (input vertices) + (number of the record). Ids are
/// never reused, and faces keep their id (their number in the input) and their corner slots, so undoing a record is
/// exact: faces_of_i get i back for k, faces_of_j get j, the dead faces return with the corners stored here.
struct Collapse {
    int i = -1, j = -1, k = -1;
    Vec3 rest_i, rest_j, rest_k; ///< m
    std::vector<int> ring;       ///< neighbours of k right after the collapse
    std::vector<int> dead_faces; ///< those on the edge
    std::vector<Face> dead_corners;
    std::vector<int> faces_of_i, faces_of_j; ///< surviving faces whose corner i (j) became k
};

/// A mesh of the hierarchy in compact numbering: vertex v has id vertex_ids[v] (ascending), face f has id face_ids[f]
/// (ascending). On the finest level vertex ids are 0, 1, 2, ..., and a vertex keeps its id on all levels that have it.
/// The id of a face is the number of the input's face that it is what is left of, or a part of.
struct HierarchyLevel {
    Positions rest; ///< m
    std::vector<Face> faces;
    std::vector<int> vertex_ids;
    std::vector<int> face_ids;
    std::vector<int> part;  ///< per vertex, as in the input
    std::vector<int> label; ///< per vertex: -1 free, else pinned; equal ones may merge

    std::vector<Anchor> to_finest; ///< one per vertex of the finest level, on this level's faces
    std::vector<Anchor> on_input;  ///< one per vertex of this level, on the faces of the input's level
    std::vector<Anchor> to_next;   ///< one per vertex of the next finer level; empty on the finest

    /// Collapses to undo on the way to the next finer level, in batches: the records of a batch are legal and their
    /// rings are disjoint once all batches before it are done. Empty on the finest.
    std::vector<std::vector<int>> batches;

    /// The next finer level's rest positions from this level's, where that is this one subdivided: one row for every
    /// vertex of the finer level. Else empty.
    ProlongationWeights subdivision;
};

/// Nested levels of one mesh, 0 the coarsest: made by edge collapse from the finest down (decimate(); PSQ sections 4.1
/// and 4.4.4), or by subdivision from the coarsest up (subdivide(); PSQ section 3.3). The one it was made from is the
/// input's.
struct Hierarchy {
    std::vector<HierarchyLevel> levels;
    std::vector<Collapse> collapses; ///< in the order they were made, from fine to coarse; none by subdivision

    int level_count() const { return static_cast<int>(levels.size()); }
    const HierarchyLevel& finest() const { return levels.back(); }
    bool is_subdivided() const { return levels.front().subdivision.rows() > 0; }
    int input_level() const { return is_subdivided() ? 0 : level_count() - 1; }
};

} // namespace plisse
