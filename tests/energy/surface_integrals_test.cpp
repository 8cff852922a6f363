#include <plisse/energy/surface_integrals.h>

#include <gtest/gtest.h>

#include <energy/assembled_fixtures.h>
#include <energy/shell_fixtures.h>
#include <energy/spline_grid.h>

namespace plisse {
namespace {

using testing::SplineGrid;

/// A sheet of 0.8 m x 0.6 m with samples enough for an exact mass.
struct Sheet {
    SplineGrid grid{8, 6};
    SurfaceBasis basis = grid.basis(4);
    Positions rest = grid.flat(0.8, 0.6);
    Eigen::SparseMatrix<double> matrix = consistent_matrix(surface_samples(basis, rest), static_cast<int>(rest.cols()));
};

/// The samples of the sheet's lower edge.
SurfaceSamples lower_edge(const Sheet& sheet) {
    const auto rule = testing::gauss_rule(4);
    const auto at_edge = testing::cubic_splines(0);
    Eigen::MatrixXd value(16, 4), tangent(16, 4);
    std::vector<double> weights;
    for (int p = 0; p < 4; ++p) {
        const auto along = testing::cubic_splines(rule[static_cast<std::size_t>(p)][0]);
        weights.push_back(rule[static_cast<std::size_t>(p)][1]);
        for (int k = 0; k < 16; ++k) {
            value(k, p) = along(0, k % 4) * at_edge(0, k / 4);
            tangent(k, p) = along(1, k % 4) * at_edge(0, k / 4);
        }
    }
    SurfaceSamples samples;
    for (int i = 0; i < sheet.grid.nx; ++i)
        append_edge(sheet.grid.control_points(i, 0), value, tangent, weights, sheet.rest, samples);
    return samples;
}

TEST(ConsistentMatrix, IsTheIntegralOfProductsOfSplines) {
    const Sheet sheet;
    const double cell = 0.1 * 0.1;
    const auto at = [&](int i, int j) {
        return sheet.matrix.coeff(sheet.grid.vertex(5, 4), sheet.grid.vertex(5 + i, 4 + j));
    };
    const double line[4] = {151.0 / 315, 397.0 / 1680, 1.0 / 42, 1.0 / 5040};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            EXPECT_NEAR(at(i, j), cell * line[i] * line[j], 1e-15 * cell);
    EXPECT_NEAR(sheet.matrix.sum(), 0.48, 1e-14);
}

TEST(SurfaceInertia, OfATranslationIsThatOfItsMass) {
    Sheet sheet;
    SurfaceInertia inertia(0.4 * sheet.matrix, sheet.rest);
    inertia.set_time_step(0.2);
    const Vec3 shift(0.1, -0.2, 0.3);
    EXPECT_EQ(inertia.value(sheet.rest), 0);
    EXPECT_NEAR(inertia.value(sheet.rest.colwise() + shift), 0.4 * 0.48 * shift.squaredNorm() / (2 * 0.04), 1e-13);
    inertia.set_target(sheet.rest.colwise() + shift);
    EXPECT_EQ(inertia.value(sheet.rest.colwise() + shift), 0);
    // A small change far from the origin keeps its digits.
    const Positions far = sheet.rest.colwise() + Vec3(1024, 0, 0);
    Positions near_far = far;
    near_far.row(2).array() += 1e-7;
    inertia.set_target(far);
    EXPECT_NEAR(inertia.value(near_far) / (0.4 * 0.48 * 1e-14 / (2 * 0.04)), 1, 1e-12);
}

TEST(SurfaceInertia, Derivatives) {
    const SplineGrid grid{3, 2};
    const SurfaceBasis basis = grid.basis(4);
    const Positions rest = grid.flat(0.3, 0.2);
    SurfaceInertia inertia(0.4 * consistent_matrix(surface_samples(basis, rest), grid.vertex_count()), rest);
    inertia.set_time_step(0.5);
    const auto errors = testing::assembled_errors(inertia, testing::perturbed(rest, 0.1), 1e-3);
    EXPECT_LT(errors.gradient, 1e-10);
    EXPECT_LT(errors.hessian, 1e-10);
}

TEST(PointPenalty, IntegratesAlongTheEdge) {
    const Sheet sheet;
    PointPenalty penalty(lower_edge(sheet), 5, sheet.rest);
    EXPECT_EQ(penalty.value(sheet.rest), 0);
    const Vec3 shift(0.1, -0.2, 0.3);
    EXPECT_NEAR(penalty.value(sheet.rest.colwise() + shift), 5.0 / 2 * 0.8 * shift.squaredNorm(), 1e-14);
    // Turned about z with x = b + t e_y, t = 0 .. 0.8: the integral of t^2.
    Positions sheared = sheet.rest;
    sheared.row(1) += sheet.rest.row(0);
    EXPECT_NEAR(penalty.value(sheared), 5.0 / 2 * 0.8 * 0.8 * 0.8 / 3, 1e-14);
    penalty.set_targets(penalty.points(sheared));
    EXPECT_EQ(penalty.value(sheared), 0);
}

TEST(PointPenalty, Derivatives) {
    const Sheet sheet;
    PointPenalty penalty(lower_edge(sheet), 5, sheet.rest);
    const auto errors = testing::assembled_errors(penalty, testing::perturbed(sheet.rest, 0.1), 1e-3);
    EXPECT_LT(errors.gradient, 1e-10);
    EXPECT_LT(errors.hessian, 1e-10);
}

TEST(PointPenalty, HoldsSinglePoints) {
    const Sheet sheet;
    VecX corner(9); // the limit point of control point (1, 1)
    corner << 1, 4, 1, 4, 16, 4, 1, 4, 1;
    std::vector<int> control;
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            control.push_back(sheet.grid.vertex(i, j));
    SurfaceSamples samples;
    samples.append(control, corner / 36, 1);
    PointPenalty penalty(samples, 7, sheet.rest);
    EXPECT_LT(penalty.points(sheet.rest).norm(), 1e-16);
    penalty.set_targets(Vec3(0, 0, 0.5));
    EXPECT_NEAR(penalty.value(sheet.rest), 7.0 / 2 * 0.25, 1e-14);
    EXPECT_LT(testing::assembled_errors(penalty, sheet.rest, 1e-3).hessian, 1e-10);
}

TEST(DeadLoads, WeightPullsTheCentre) {
    const Sheet sheet;
    const Vec3 gravity(0, 0, -9.81);
    const DeadLoads weight(surface_weight(0.4 * sheet.matrix, gravity));
    EXPECT_NEAR(weight.value(sheet.rest.colwise() + Vec3(1, 2, 3)), 0.4 * 0.48 * 9.81 * 3, 1e-12);
    const VecX x = as_vector(testing::perturbed(sheet.rest, 0.1));
    const VecX slope = testing::gradient_of(weight, x);
    EXPECT_NEAR(slope.sum(), 0.4 * 0.48 * 9.81, 1e-13);
    EXPECT_NEAR(slope.dot(x), weight.value(as_positions(x)), 1e-13);
}

} // namespace
} // namespace plisse
