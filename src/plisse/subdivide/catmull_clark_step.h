#pragma once

#include <Eigen/SparseCore>

#include <plisse/subdivide/control_mesh.h>

namespace plisse {

/// Acts on values of the columns' vertices: fine = coarse * weights.transpose() for positions.
using VertexWeights = Eigen::SparseMatrix<double>;

/// What a vertex of a subdivided mesh comes from.
struct VertexOrigin {
    enum class Kind { vertex, edge, face };
    Kind kind;
    int number; ///< of the coarse vertex, of the coarse edge (of its connectivity()) or of the coarse face
};

/// One Catmull-Clark subdivision.
struct CatmullClarkStep {
    ControlMesh fine;
    VertexWeights weights;                   ///< S: one row for every fine vertex, one column for every coarse one
    std::vector<VertexOrigin> origin;        ///< per fine vertex
    std::vector<int> vertex_child;           ///< per coarse vertex: its fine vertex, -1 where trimmed
    std::vector<int> edge_child, face_child; ///< likewise per coarse edge and coarse face
};

/// Catmull-Clark's rules (RMTR equations 5.12 to 5.14, by OpenSubdiv) and its ghost ring trimmed to one ring again. No
/// boundary rule enters: only vertices surrounded by faces are placed by S at all, with the edges and faces around
/// them. Fine domain face 4 f + c is the quarter of coarse face f at its corner c, and runs like it: its (u, v) are 2
/// (u, v) - (0, 0), (1, 0), (1, 1), (0, 1) of the coarse ones for c = 0 .. 3. Fine boundary side 2 b + i is half i of
/// coarse boundary side b. Fine vertices are those of vertices, edges, faces, in the coarse order; domain first.
CatmullClarkStep catmull_clark_step(const ControlMesh& coarse);

} // namespace plisse
