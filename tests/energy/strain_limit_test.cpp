#include <plisse/energy/strain_limit.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <Eigen/SVD>

#include <energy/shell_fixtures.h>
#include <plisse/geometry/barrier.h>

namespace plisse {
namespace {

using testing::derivative_errors;
using testing::make_sheet;
using testing::perturbed;
using testing::total_gradient;
using testing::total_hessian;
using testing::total_value;

constexpr double limit = 1.1, onset = 1.05, stiffness = 3;

StrainLimitEnergy make_limit(const TriangleMesh& mesh) {
    const std::size_t count = mesh.faces.size();
    return {
        mesh.positions,
        mesh.faces,
        {std::vector<double>(count, onset), std::vector<double>(count, limit), std::vector<double>(count, stiffness)}};
}

TriangleMesh irregular_sheet() {
    return make_sheet(3, 3, 1, 1, testing::Cells::random, 0.2);
}

/// The sheet under two principal stretches, the larger at an angle to the mesh, turned in space.
Positions stretched(const TriangleMesh& mesh, double s1, double s2, double angle) {
    Random random(5);
    Mat3 stretch = Mat3::Identity();
    stretch(0, 0) = s1;
    stretch(1, 1) = s2;
    return testing::random_rotation(random) * stretch * Eigen::AngleAxisd(angle, Vec3::UnitZ()).toRotationMatrix() *
           mesh.positions;
}

Mat32 random_matrix(Random& random, double size) {
    return Mat32::NullaryExpr([&](int, int) { return random.uniform(-size, size); });
}

double largest_singular_value(const Mat32& F) {
    return Eigen::JacobiSVD<Mat32>(F).singularValues()[0];
}

TEST(StrainLimit, ValueIsTheFormula) {
    const TriangleMesh mesh = irregular_sheet();
    const StrainLimitEnergy energy = make_limit(mesh);
    const auto one = [](double s) { return barrier((limit - s) / (limit - onset)).value; };
    for (const auto& [s1, s2] : {std::pair{1.09, 1.07}, {1.09, 0.8}, {1.0999, 1.0999}})
        EXPECT_NEAR(total_value(energy, as_vector(stretched(mesh, s1, s2, 0.7))), stiffness * (one(s1) + one(s2)), 1e-9)
            << s1 << " " << s2;
}

TEST(StrainLimit, IsNothingUpToItsOnsetAndInfiniteAtItsLimit) {
    const TriangleMesh mesh = irregular_sheet();
    const StrainLimitEnergy energy = make_limit(mesh);
    for (const auto& [s1, s2] : {std::pair{1.0, 1.0}, {1.0499, 1.0499}, {1.0499, 0.1}}) {
        const VecX x = as_vector(stretched(mesh, s1, s2, 0.7));
        EXPECT_EQ(total_value(energy, x), 0);
        EXPECT_EQ(total_gradient(energy, x).cwiseAbs().maxCoeff(), 0);
        EXPECT_EQ(total_hessian(energy, x, false).cwiseAbs().maxCoeff(), 0);
    }
    for (double s1 : {limit + 1e-12, 1.2, 5.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_EQ(total_value(energy, as_vector(stretched(mesh, s1, 1, 0.7))), std::numeric_limits<double>::infinity());
    double before = 0;
    for (double room = 1e-2; room > 1e-10; room /= 10) {
        const double value = total_value(energy, as_vector(stretched(mesh, limit - room, 1, 0.7)));
        EXPECT_GT(value, before);
        before = value;
    }
}

/// Faces under the onset and beyond it, even and uneven stretches, alike and nearly alike.
TEST(StrainLimit, DerivativesAgreeWithDifferences) {
    const TriangleMesh mesh = irregular_sheet();
    const StrainLimitEnergy energy = make_limit(mesh);
    for (const auto& [s1, s2] : {std::pair{1.08, 1.07},
                                 {1.08, 0.7},
                                 {1.08, 1.08},
                                 {1.08, 1.08 - 1e-9},
                                 {1.08, 1.045},
                                 {1.053, 1.052},
                                 {1.09, 1.06}}) {
        const Positions x = perturbed(stretched(mesh, s1, s2, 0.7), 1e-3);
        const auto errors = derivative_errors(energy, x, 0.02);
        EXPECT_LT(errors.gradient, 1e-6) << s1 << " " << s2;
        EXPECT_LT(errors.hessian, 1e-5) << s1 << " " << s2;
        const auto exact = derivative_errors(energy, stretched(mesh, s1, s2, 0.7), 0.02);
        EXPECT_LT(exact.gradient, 1e-6) << s1 << " " << s2;
        EXPECT_LT(exact.hessian, 1e-5) << s1 << " " << s2;
    }
}

TEST(StrainLimit, HessianIsPositiveSemiDefiniteAsItIs) {
    const TriangleMesh mesh = irregular_sheet();
    const StrainLimitEnergy energy = make_limit(mesh);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const Positions x = perturbed(stretched(mesh, 1.06, 1.05, 0.7), 3e-3, seed);
        const Eigen::MatrixXd hessian = total_hessian(energy, as_vector(x), false);
        ASSERT_GT(hessian.cwiseAbs().maxCoeff(), 0);
        EXPECT_GT(testing::lowest_eigenvalue(hessian), -1e-12 * hessian.cwiseAbs().maxCoeff());
        EXPECT_EQ(total_hessian(energy, as_vector(x), true), hessian);
    }
}

TEST(StrainLimit, IsTwiceContinuouslyDifferentiableAtItsOnset) {
    const TriangleMesh mesh = irregular_sheet();
    const StrainLimitEnergy energy = make_limit(mesh);
    const double scale = total_hessian(energy, as_vector(stretched(mesh, 1.08, 1, 0.7)), false).norm();
    double before = scale;
    for (double above = 1e-2; above > 1e-8; above /= 10) {
        const double norm = total_hessian(energy, as_vector(stretched(mesh, onset + above, 1, 0.7)), false).norm();
        EXPECT_LT(norm, 0.2 * before);
        before = norm;
    }
}

/// Against the singular values on a fine grid of steps.
TEST(LimitedStep, NeverPassesTheBoundAndNearlyReachesIt) {
    Random random(3);
    int cut = 0;
    for (int sample = 0; sample < 2000; ++sample) {
        const Mat32 F = random_matrix(random, 1);
        const double size = std::pow(10, random.uniform(-3, 3));
        const Mat32 d = random_matrix(random, size);
        const double bound = largest_singular_value(F) * (1 + std::pow(10, random.uniform(-9, 0)));
        const double end = random.uniform(0.1, 1);
        const double step = limited_step(F, d, bound, end);
        ASSERT_GE(step, 0);
        ASSERT_LE(step, end);
        constexpr int grid = 200;
        for (int k = 0; k <= grid; ++k)
            EXPECT_LE(largest_singular_value(F + step * k / grid * d), bound * (1 + 1e-14)) << sample;
        if (step == end)
            continue;
        ++cut;
        EXPECT_GT(largest_singular_value(F + step * 1.03 * d), bound) << sample;
    }
    EXPECT_GT(cut, 500);
}

TEST(LimitedStep, LeavesATurningTriangleAlone) {
    Mat32 F = Mat32::Zero();
    F(0, 0) = F(1, 1) = 1.09;
    const Mat32 turned = Eigen::AngleAxisd(1.5, Vec3::UnitX()).toRotationMatrix() * F;
    EXPECT_EQ(limited_step(F, turned - F, 1.0901, 1), 1);
}

TEST(LimitedStep, IsNoneAtTheBoundUnlessTheStretchShrinks) {
    Mat32 F = Mat32::Zero();
    F(0, 0) = F(1, 1) = 1.1;
    Mat32 d = Mat32::Zero();
    d(0, 0) = 0.1;
    EXPECT_LT(limited_step(F, d, principal_stretches(F)[0], 1), 1e-14);
    EXPECT_EQ(limited_step(F, -F / 2, principal_stretches(F)[0], 1), 1);
    EXPECT_GT(limited_step(F, -3 * F, principal_stretches(F)[0], 1), 0.65); // through nothing and out to twice as far
    EXPECT_LE(limited_step(F, -3 * F, principal_stretches(F)[0], 1), 2.0 / 3);
}

TEST(StrainLimit, StepsKeepAShareOfTheRoom) {
    const TriangleMesh mesh = irregular_sheet();
    const StrainLimitEnergy energy = make_limit(mesh);
    Positions x = stretched(mesh, 1.08, 0.9, 0.7);
    const Positions away = stretched(mesh, 1.5, 0.9, 0.7);
    double room = limit - 1.08;
    for (int step = 0; step < 12; ++step) {
        const double alpha = energy.max_step(x, away - x);
        x += alpha * (away - x);
        const double left = limit - energy.triangles().largest_stretch(x);
        EXPECT_GE(left, 0.0999 * room);
        EXPECT_GE(left, 0.99e-6 * (limit - onset));
        EXPECT_TRUE(std::isfinite(total_value(energy, as_vector(x))));
        room = left;
    }
    EXPECT_LT(room, 1.1e-6 * (limit - onset));
    EXPECT_EQ(energy.max_step(x, mesh.positions - x), 1);
}

TEST(StrainLimit, NoFacesLimitNothing) {
    const TriangleMesh mesh = irregular_sheet();
    const StrainLimitEnergy energy(mesh.positions, {}, {});
    EXPECT_EQ(total_value(energy, as_vector(mesh.positions)), 0);
    EXPECT_EQ(energy.max_step(mesh.positions, 10 * mesh.positions), 1);
}

} // namespace
} // namespace plisse
