#include <plisse/subdivide/boundary_variables.h>

#include <gtest/gtest.h>

#include <algorithm>

#include "quad_samples.h"

namespace plisse {
namespace {

TEST(BoundaryVariables, CanBeTurnedBack) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        const ControlMesh mesh = with_ghost_ring(quads).mesh;
        const auto& [to, from] = boundary_variables(mesh);
        EXPECT_LT(largest(to * from - identity(mesh.vertex_count)), 1e-14) << name;
        EXPECT_LT(largest(from * to - identity(mesh.vertex_count)), 1e-14) << name;
        const VecX ones = VecX::Ones(mesh.vertex_count);
        EXPECT_LT((from * ones - ones).cwiseAbs().maxCoeff(), 1e-15) << name;
    }
}

bool has_reentrant_corner(const ControlMesh& mesh) {
    const std::vector<Ghost> ghosts = find_ghosts(mesh);
    return std::any_of(ghosts.begin(), ghosts.end(), [](const Ghost& g) { return g.kind == Ghost::Kind::reentrant; });
}

/// Which variables stand for something else than their control point.
std::vector<bool> replaced(const ControlMesh& mesh, const ControlVariables& variables) {
    std::vector<bool> result;
    for (int v = 0; v < mesh.vertex_count; ++v) {
        const VecX unit = VecX::Unit(mesh.vertex_count, v);
        const VecX row = variables.from_control_points.transpose() * unit;
        result.push_back(row != unit);
    }
    return result;
}

/// The replaced variables alone are the boundary; as many as a boundary has coefficients.
TEST(BoundaryVariables, HoldTheBoundary) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        // Divided twice, re-entrant corners do not share vertices.
        const ControlMesh mesh = catmull_clark_step(catmull_clark_step(with_ghost_ring(quads).mesh).fine).fine;
        const ControlVariables variables = boundary_variables(mesh);
        const std::vector<bool> is_replaced = replaced(mesh, variables);
        const BoundaryBasis basis = in_variables(boundary_basis(mesh), variables);
        for (int e = 0; e < basis.edge_count(); ++e)
            for (int v : basis.control_points(e))
                EXPECT_TRUE(is_replaced[static_cast<std::size_t>(v)]) << name << " " << v;
        const std::vector<Ghost> ghosts = find_ghosts(mesh);
        const auto corners = std::count_if(ghosts.begin(), ghosts.end(),
                                           [](const Ghost& g) { return g.kind == Ghost::Kind::reentrant; });
        EXPECT_EQ(std::count(is_replaced.begin(), is_replaced.end(), true),
                  static_cast<long>(ghosts.size()) + 4 * corners)
            << name;
    }
}

TEST(BoundaryVariables, OfACornerAreItsLimit) {
    const ControlMesh mesh = with_ghost_ring(flat_grid(3, 2)).mesh;
    const Positions p = random_positions(mesh.vertex_count);
    const Positions q = p * boundary_variables(mesh).from_control_points.transpose();
    const Positions limits = p * limit_points(mesh).weights.transpose();
    const std::vector<Ghost> ghosts = find_ghosts(mesh);
    int corners = 0;
    for (std::size_t i = 0; i < ghosts.size(); ++i)
        if (ghosts[i].kind == Ghost::Kind::corner) {
            ++corners;
            const int g = mesh.domain_vertex_count + static_cast<int>(i);
            EXPECT_LT((q.col(g) - limits.col(ghosts[i].vertex)).norm(), 1e-14);
        }
    EXPECT_EQ(corners, 4);
}

TEST(BoundaryVariables, DescribeTheSameSurface) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        const ControlMesh mesh = with_ghost_ring(quads).mesh;
        const ControlVariables variables = boundary_variables(mesh);
        const SurfaceBasis in_p = surface_basis(mesh, 3), in_q = in_variables(in_p, variables);
        const Positions p = random_positions(mesh.vertex_count);
        const Positions q = p * variables.from_control_points.transpose();
        for (int f = 0; f < in_p.face_count(); ++f) {
            const auto a = in_p.control_points(f), b = in_q.control_points(f);
            const auto beyond =
                std::count_if(b.begin(), b.end(), [&](int v) { return std::find(a.begin(), a.end(), v) == a.end(); });
            EXPECT_LE(beyond, has_reentrant_corner(mesh) ? 6 : 0) << name;
            for (auto m : {&FaceStencil::value, &FaceStencil::du, &FaceStencil::dv, &FaceStencil::duu,
                           &FaceStencil::duv, &FaceStencil::dvv})
                EXPECT_LT(
                    (evaluated(in_p.stencil(f).*m, a, p) - evaluated(in_q.stencil(f).*m, b, q)).cwiseAbs().maxCoeff(),
                    1e-12)
                    << name;
        }
    }
    const ControlMesh large = with_ghost_ring(flat_grid(9, 9)).mesh;
    EXPECT_EQ(in_variables(surface_basis(large, 3), boundary_variables(large)).kind_count(), 9);
}

} // namespace
} // namespace plisse
