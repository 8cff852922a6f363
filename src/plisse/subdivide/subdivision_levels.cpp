#include <plisse/subdivide/subdivision_levels.h>

#include <cassert>

namespace plisse {

SubdivisionLevels::SubdivisionLevels(const QuadMesh& quads, int level_count, SurfaceVariables kind) {
    assert(level_count >= 1);
    const auto variables_of = [kind](const ControlMesh& m) {
        return kind == SurfaceVariables::control_points ? plain_variables(m) : boundary_variables(m);
    };
    ControlCage cage = with_ghost_ring(quads);
    coarsest_ = std::move(cage.mesh);
    variables_.push_back(variables_of(coarsest_));
    Positions points = std::move(cage.positions);
    rest_.push_back(variables(0, points));
    for (int level = 0; level + 1 < level_count; ++level) {
        CatmullClarkStep step = catmull_clark_step(mesh(level));
        const VertexWeights projection = reverse_subdivision(mesh(level), step);
        points = points * step.weights.transpose();
        steps_.push_back(std::move(step));
        variables_.push_back(variables_of(mesh(level + 1)));
        rest_.push_back(variables(level + 1, points));
        subdivisions_.push_back(in_variables(steps_.back().weights, of_level(level), of_level(level + 1)));
        projections_.push_back(in_variables(projection, of_level(level + 1), of_level(level)));
    }
}

SurfaceBasis SubdivisionLevels::surface_basis(int level, int gauss_points_a_side) const {
    return in_variables(plisse::surface_basis(mesh(level), gauss_points_a_side), of_level(level));
}

BoundaryBasis SubdivisionLevels::boundary_basis(int level) const {
    return in_variables(plisse::boundary_basis(mesh(level)), of_level(level));
}

LimitPoints SubdivisionLevels::limit_points(int level, int parts_a_side) const {
    return in_variables(plisse::limit_points(mesh(level), parts_a_side), of_level(level));
}

LeastSquaresProjection SubdivisionLevels::least_squares_projection(int level) const {
    return {step(level).weights, of_level(level + 1).to_control_points, of_level(level).from_control_points};
}

Positions SubdivisionLevels::control_points(int level, const ConstPositions& variables) const {
    return variables * of_level(level).to_control_points.transpose();
}

Positions SubdivisionLevels::variables(int level, const ConstPositions& control_points) const {
    return control_points * of_level(level).from_control_points.transpose();
}

} // namespace plisse
