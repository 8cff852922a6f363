#pragma once

#include <plisse/subdivide/catmull_clark_step.h>

namespace plisse {

/// Points of a limit surface and the quadrilaterals between them, which run like the faces of the control mesh.
struct LimitPoints {
    VertexWeights weights; ///< one row for every point, one column for every control point
    std::vector<Quad> quads;
};

/// The limits of the domain vertices, in their order, and where parts_a_side > 1 the points between them that cut each
/// domain face into parts_a_side x parts_a_side by even steps of its parameters: those of edges, then those of faces.
/// The quads of face 0 come first; of one face they are ordered by v, then u. A vertex of valence n goes to
/// (n^2 v + 4 sum of edge neighbours + sum of the faces' far corners) / (n (n + 5)) (Halstead, Kass and DeRose 1993).
LimitPoints limit_points(const ControlMesh& mesh, int parts_a_side = 1);

} // namespace plisse
