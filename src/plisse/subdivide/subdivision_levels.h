#pragma once

#include <plisse/subdivide/boundary_variables.h>
#include <plisse/subdivide/projection.h>

namespace plisse {

enum class SurfaceVariables {
    control_points,
    boundary_curve, ///< boundary_variables
};

/// A Catmull-Clark surface on nested levels, 0 the coarsest, each the one before divided once (RMTR section 5): the
/// same rest surface on all. Whatever is asked for is in the variables chosen, one for every vertex of a level's mesh;
/// only control_points() and variables() know more.
class SubdivisionLevels {
public:
    /// quads: the domain of level 0. level_count >= 1: 4 from 4 x 4 faces end with 32 x 32.
    /// Throws InputError (with an empty place) as with_ghost_ring and reverse_subdivision do.
    SubdivisionLevels(const QuadMesh& quads, int level_count, SurfaceVariables variables);

    int level_count() const { return static_cast<int>(variables_.size()); }
    int vertex_count(int level) const { return mesh(level).vertex_count; }
    const ControlMesh& mesh(int level) const { return level == 0 ? coarsest_ : step(level - 1).fine; }
    /// From a level to the next finer one; its weights are those of control points.
    const CatmullClarkStep& step(int level) const { return steps_[static_cast<std::size_t>(level)]; }

    const Positions& rest(int level) const { return rest_[static_cast<std::size_t>(level)]; }
    SurfaceBasis surface_basis(int level, int gauss_points_a_side) const;
    BoundaryBasis boundary_basis(int level) const;
    LimitPoints limit_points(int level, int parts_a_side = 1) const;

    /// S from a level to the next finer one, and P back by reverse subdivision and by least squares: P S = I.
    const VertexWeights& subdivision(int level) const { return subdivisions_[static_cast<std::size_t>(level)]; }
    const VertexWeights& projection(int level) const { return projections_[static_cast<std::size_t>(level)]; }
    LeastSquaresProjection least_squares_projection(int level) const;

    Positions control_points(int level, const ConstPositions& variables) const;
    Positions variables(int level, const ConstPositions& control_points) const;

private:
    const ControlVariables& of_level(int level) const { return variables_[static_cast<std::size_t>(level)]; }

    ControlMesh coarsest_;
    std::vector<CatmullClarkStep> steps_;
    std::vector<ControlVariables> variables_;
    std::vector<Positions> rest_;
    std::vector<VertexWeights> subdivisions_, projections_;
};

} // namespace plisse
