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

/// Domain vertices are as they are. A ghost across an edge, in a row p_-1 p_0 p_1 across the boundary, is replaced by
/// the coefficient of the boundary curve there, r = (p_-1 + 4 p_0 + p_1) / 6; one at a convex corner by the tensor
/// product of that, which is the limit of the corner. So a boundary without re-entrant corners is a curve of these
/// alone, and holding it couples nothing else. A ghost at a re-entrant corner stays as it is: it lies in two rows, so
/// it can be the coefficient of one of the two curves only, and the other is then stiffer than before; and any rule
/// that treats both sides alike needs vertices beyond the 16 that a face beside the corner depends on. T and T^-1 are
/// as local as the rows: a face's control points depend on the variables at them alone.
ControlVariables boundary_variables(const ControlMesh& mesh);

/// The same functions in terms of q, and the same maps between levels: weights that cancel are left out.
SurfaceBasis in_variables(const SurfaceBasis& basis, const ControlVariables& variables);
BoundaryBasis in_variables(const BoundaryBasis& basis, const ControlVariables& variables);
LimitPoints in_variables(const LimitPoints& points, const ControlVariables& variables);
/// weights: from the control points of one mesh to those of another.
VertexWeights in_variables(const VertexWeights& weights, const ControlVariables& from, const ControlVariables& to);

} // namespace plisse
