#include <plisse/subdivide/subdivision_levels.h>

#include <gtest/gtest.h>

#include <plisse/mesh/quad_mesh.h>

#include "quad_samples.h"

namespace plisse {
namespace {

constexpr std::array<SurfaceVariables, 2> both = {SurfaceVariables::control_points, SurfaceVariables::boundary_curve};

TEST(SubdivisionLevels, HaveAPartitionOfUnity) {
    for (const auto& [name, quads, ordinary] : quad_samples())
        for (SurfaceVariables variables : both) {
            const SubdivisionLevels levels(quads, 2, variables);
            for (int level : {0, 1})
                for (int gauss : {2, 3, 4}) {
                    const SurfaceBasis basis = levels.surface_basis(level, gauss);
                    for (int f = 0; f < basis.face_count(); ++f) {
                        const FaceStencil& s = basis.stencil(f);
                        EXPECT_LT((s.value.colwise().sum().array() - 1).abs().maxCoeff(), 1e-13) << name;
                        for (const Eigen::MatrixXd* m : {&s.du, &s.dv, &s.duu, &s.duv, &s.dvv})
                            EXPECT_LT(m->colwise().sum().cwiseAbs().maxCoeff(), ordinary ? 1e-12 : 1e-10) << name;
                    }
                }
            const BoundaryBasis boundary = levels.boundary_basis(1);
            for (int e = 0; e < boundary.edge_count(); ++e) {
                EXPECT_LT((boundary.stencil(e).value.colwise().sum().array() - 1).abs().maxCoeff(), 1e-13) << name;
                EXPECT_LT(boundary.stencil(e).tangent.colwise().sum().cwiseAbs().maxCoeff(), 1e-12) << name;
            }
        }
}

TEST(SubdivisionLevels, KeepTheSurface) {
    for (const auto& [name, quads, ordinary] : quad_samples())
        for (SurfaceVariables variables : both) {
            const SubdivisionLevels levels(quads, 2, variables);
            const VecX ones = VecX::Ones(levels.vertex_count(0));
            EXPECT_LT((levels.subdivision(0) * ones - VecX::Ones(levels.vertex_count(1))).cwiseAbs().maxCoeff(), 1e-13)
                << name;
            const Positions x = random_positions(levels.vertex_count(0));
            const Positions fine = x * levels.subdivision(0).transpose();
            const SurfaceBasis fine_basis = levels.surface_basis(1, 3);
            const auto points = gauss_on_square(3).points;
            for (int quarter = 0; quarter < 4; ++quarter) {
                Quadrature<Vec2> same = gauss_on_square(3);
                for (Vec2& point : same.points)
                    point = 0.5 * (point + Vec2(quarter == 1 || quarter == 2 ? 1 : 0, quarter >= 2 ? 1 : 0));
                const SurfaceBasis basis =
                    in_variables(surface_basis(levels.mesh(0), same), variables == SurfaceVariables::control_points
                                                                          ? plain_variables(levels.mesh(0))
                                                                          : boundary_variables(levels.mesh(0)));
                for (int f = 0; f < basis.face_count(); ++f) {
                    const int child = 4 * f + quarter;
                    const auto difference = [&](Eigen::MatrixXd FaceStencil::*m, double scale) {
                        return (evaluated(basis.stencil(f).*m, basis.control_points(f), x) -
                                scale * evaluated(fine_basis.stencil(child).*m, fine_basis.control_points(child), fine))
                            .cwiseAbs()
                            .maxCoeff();
                    };
                    EXPECT_LT(difference(&FaceStencil::value, 1), 1e-12) << name;
                    EXPECT_LT(difference(&FaceStencil::du, 2), 1e-12) << name;
                    EXPECT_LT(difference(&FaceStencil::dv, 2), 1e-12) << name;
                    EXPECT_LT(difference(&FaceStencil::duu, 4), 1e-10) << name;
                    EXPECT_LT(difference(&FaceStencil::duv, 4), 1e-10) << name;
                    EXPECT_LT(difference(&FaceStencil::dvv, 4), 1e-10) << name;
                }
            }
        }
}

TEST(SubdivisionLevels, ProjectBack) {
    for (const auto& [name, quads, ordinary] : quad_samples())
        for (SurfaceVariables variables : both) {
            const SubdivisionLevels levels(quads, 3, variables);
            for (int level : {0, 1}) {
                const VertexWeights& s = levels.subdivision(level);
                EXPECT_LT(largest(levels.projection(level) * s - identity(levels.vertex_count(level))), 1e-12) << name;
                const LeastSquaresProjection nearest = levels.least_squares_projection(level);
                const Positions x = random_positions(levels.vertex_count(level));
                EXPECT_LT((nearest.apply(x * s.transpose()) - x).cwiseAbs().maxCoeff(), 1e-12) << name;
            }
        }
}

/// On a flat even grid, ghosts and all, the surface is the grid's plane at even speed.
TEST(SubdivisionLevels, KeepAFlatSheetFlat) {
    const QuadMesh quads = quad_sheet({1, 0.75}, {4, 3});
    for (SurfaceVariables variables : both) {
        const SubdivisionLevels levels(quads, 4, variables);
        EXPECT_EQ(levels.mesh(3).domain_face_count, 32 * 24);
        for (int level = 0; level < 4; ++level) {
            const Positions& x = levels.rest(level);
            const SurfaceBasis basis = levels.surface_basis(level, 3);
            const double h = 0.25 / (1 << level);
            double area = 0;
            for (int f = 0; f < basis.face_count(); ++f) {
                const FaceStencil& s = basis.stencil(f);
                const auto points = basis.control_points(f);
                EXPECT_LT((evaluated(s.du, points, x).colwise() - Vec3(0, 0, h)).cwiseAbs().maxCoeff(), 1e-14);
                EXPECT_LT((evaluated(s.dv, points, x).colwise() - Vec3(h, 0, 0)).cwiseAbs().maxCoeff(), 1e-14);
                for (const Eigen::MatrixXd* m : {&s.duu, &s.duv, &s.dvv})
                    EXPECT_LT(evaluated(*m, points, x).cwiseAbs().maxCoeff(), 1e-13);
                const Positions du = evaluated(s.du, points, x), dv = evaluated(s.dv, points, x);
                for (int i = 0; i < basis.point_count(); ++i)
                    area += basis.weight(i) * du.col(i).head<3>().cross(dv.col(i).head<3>()).y();
            }
            EXPECT_NEAR(area, 0.75, 1e-13);
            double length = 0;
            const BoundaryBasis boundary = levels.boundary_basis(level);
            for (int e = 0; e < boundary.edge_count(); ++e) {
                const auto& s = boundary.stencil(e);
                const Positions t = evaluated(s.tangent, boundary.control_points(e), x);
                for (int i = 0; i < boundary.point_count(); ++i)
                    length += boundary.weight(i) * t.col(i).norm();
            }
            EXPECT_NEAR(length, 3.5, 1e-13);
            const Positions limits = x * levels.limit_points(level).weights.transpose();
            EXPECT_NEAR(limits.row(0).maxCoeff(), 0.5, 1e-14);
            EXPECT_LT((limits.leftCols(quads.vertex_count()) - quads.positions).cwiseAbs().maxCoeff(), 1e-14);
        }
    }
}

TEST(SubdivisionLevels, TurnVariablesIntoControlPoints) {
    const SubdivisionLevels plain(fan(5), 3, SurfaceVariables::control_points);
    const SubdivisionLevels curve(fan(5), 3, SurfaceVariables::boundary_curve);
    for (int level = 0; level < 3; ++level) {
        EXPECT_LT((curve.control_points(level, curve.rest(level)) - plain.rest(level)).cwiseAbs().maxCoeff(), 1e-13);
        EXPECT_LT((curve.variables(level, plain.rest(level)) - curve.rest(level)).cwiseAbs().maxCoeff(), 1e-13);
        EXPECT_GT((curve.rest(level) - plain.rest(level)).cwiseAbs().maxCoeff(), 1e-3);
    }
}

} // namespace
} // namespace plisse
