#pragma once

#include <plisse/subdivide/limit_points.h>
#include <plisse/subdivide/surface_basis.h>

namespace plisse {

/// Unknowns q that stand for the control points p of a mesh, one for each: p = T q.
struct ControlVariables {
    VertexWeights to_control_points;   ///< T
    VertexWeights from_control_points; ///< T^-1
};

/// q = p.
ControlVariables plain_variables(const ControlMesh& mesh);

/// Variables of which some are the boundary and the others have no part in it, so that a boundary held stiffly couples
/// nothing else. A ghost across an edge, in a row p_-1 p_0 p_1 across the boundary, is replaced by the coefficient of
/// the boundary curve there, r = (p_-1 + 4 p_0 + p_1) / 6; one at a convex corner by the tensor product of that, which
/// is the limit of the corner. At a re-entrant corner p between a and b, with the ghost g, two curves meet. They share
/// the limit of p, so on the nine vertices around it they have five coefficients and not six:
///     b_i  b   g      b by (d + 4 p + b) / 6     l by (b_i + 4 l + f) / 6
///     l    p   a      a by (l + 4 p + a) / 6     d by (a_i + 4 d + f) / 6
///     f    d   a_i    g by the mean of (a_i + 4 a + g) / 6 and (b_i + 4 b + g) / 6
/// (the surface is all but the quarter at g). Where these vertices belong to two such corners, they stay as they are.
/// All other domain vertices always do. T and T^-1 are as local as that: faces beside a re-entrant corner depend on a
/// few variables beyond their control points, other faces on none. (Replacing g alone, or nothing, keeps to the control
/// points, but leaves four stiff combinations a corner: in bending on an L of 16 x 16 with beta = h^-5 the condition
/// number of the diagonally scaled Hessian was 2.6e5 and 1.3e6; it is 1.9e3.)
ControlVariables boundary_variables(const ControlMesh& mesh);

/// The same functions in terms of q, and the same maps between levels: weights that cancel are left out.
SurfaceBasis in_variables(const SurfaceBasis& basis, const ControlVariables& variables);
BoundaryBasis in_variables(const BoundaryBasis& basis, const ControlVariables& variables);
LimitPoints in_variables(const LimitPoints& points, const ControlVariables& variables);
/// weights: from the control points of one mesh to those of another.
VertexWeights in_variables(const VertexWeights& weights, const ControlVariables& from, const ControlVariables& to);

} // namespace plisse
