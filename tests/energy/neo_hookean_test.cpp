#include <plisse/energy/neo_hookean.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <energy/shell_fixtures.h>

namespace plisse {
namespace {

using testing::central_differences;
using testing::general_positive_part;

struct NamedF {
    const char* name;
    Mat32 F;
};

Mat32 rotated(double s1, double s2, double angle, std::uint64_t seed) {
    Random random(seed);
    Mat32 stretch = Mat32::Zero();
    stretch(0, 0) = s1;
    stretch(1, 1) = s2;
    return testing::random_rotation(random) * stretch * Eigen::Rotation2Dd(angle).matrix();
}

std::vector<NamedF> deformations() {
    Random random(11);
    const Mat32 noise = Mat32::NullaryExpr([&](int, int) { return random.uniform(-0.2, 0.2); });
    return {{"rest", Mat32::Identity()},
            {"turned rest", rotated(1, 1, 0.3, 1)},
            {"a fifth off", Mat32::Identity() + noise},
            {"J = 0.05", rotated(0.5, 0.1, 0.4, 2)},
            {"J = 0.05, even", rotated(std::sqrt(0.05), std::sqrt(0.05), 0.4, 3)},
            {"nearly even", rotated(1.3, 1.3 + 1e-9, 1.2, 4)},
            {"stretched", rotated(2.5, 0.4, -2, 5)},
            {"blown up", rotated(3, 2.9, -2, 6)}};
}

Mat32 as_matrix(const VecX& entries) {
    return Eigen::Map<const Mat32>(entries.data());
}
VecX as_entries(const Mat32& matrix) {
    return Eigen::Map<const VecX>(matrix.data(), 6);
}

class NeoHookean : public ::testing::TestWithParam<NamedF> {
protected:
    Mat32 F() const { return GetParam().F; }
    Lame lame = plane_stress_lame(1, 0.3);
};

TEST_P(NeoHookean, ValueIsTheFormula) {
    const Mat2 C = F().transpose() * F();
    const double log_J = std::log(C.determinant()) / 2;
    const double expected = lame.mu / 2 * (C.trace() - 2 - 2 * log_J) + lame.lambda / 2 * log_J * log_J;
    EXPECT_NEAR(neo_hookean_value(F(), lame), expected, 1e-13);
}

TEST_P(NeoHookean, StressIsTheFormula) {
    const Mat2 C = F().transpose() * F();
    const Mat32 G = F() * C.inverse();
    const Mat32 expected = lame.mu * (F() - G) + lame.lambda * std::log(C.determinant()) / 2 * G;
    EXPECT_LT((neo_hookean_stress(F(), lame) - expected).norm(), 1e-13 * (1 + expected.norm()));
}

TEST_P(NeoHookean, StressAgreesWithDifferences) {
    const auto value = [&](const VecX& f) { return VecX::Constant(1, neo_hookean_value(as_matrix(f), lame)).eval(); };
    const Eigen::MatrixXd differences = central_differences(value, as_entries(F()), 1e-6);
    const VecX stress = as_entries(neo_hookean_stress(F(), lame));
    EXPECT_LT((differences.transpose() - stress).norm(), 1e-7 * (1e-2 + stress.norm()));
}

TEST_P(NeoHookean, HessianAgreesWithDifferences) {
    const auto stress = [&](const VecX& f) { return as_entries(neo_hookean_stress(as_matrix(f), lame)); };
    const Eigen::MatrixXd differences = central_differences(stress, as_entries(F()), 1e-6);
    const Mat6 hessian = plisse::hessian(neo_hookean_modes(F(), lame, false));
    EXPECT_LT((differences - hessian).norm(), 1e-6 * hessian.norm());
}

TEST_P(NeoHookean, ProjectionIsThatOfAGeneralEigenSolver) {
    const Mat6 exact = plisse::hessian(neo_hookean_modes(F(), lame, false));
    const Mat6 projected = plisse::hessian(neo_hookean_modes(F(), lame, true));
    EXPECT_LT((projected - general_positive_part(exact)).norm(), 1e-10 * exact.norm());
}

TEST_P(NeoHookean, PullBackIsTheChainRule) {
    Mat2 inverse;
    inverse << 1.3, -0.4, 0.2, 0.9;
    Eigen::Matrix<double, 6, 9> jacobian = Eigen::Matrix<double, 6, 9>::Zero();
    for (int column = 0; column < 2; ++column)
        for (int k = 1; k < 3; ++k) {
            jacobian.block<3, 3>(3 * column, 3 * k) += inverse(k - 1, column) * Mat3::Identity();
            jacobian.block<3, 3>(3 * column, 0) -= inverse(k - 1, column) * Mat3::Identity();
        }
    for (bool project : {false, true}) {
        const StretchModes modes = neo_hookean_modes(F(), lame, project);
        const Mat9 expected = 0.7 * jacobian.transpose() * plisse::hessian(modes) * jacobian;
        EXPECT_LT((pull_back(modes, inverse, 0.7) - expected).norm(), 1e-13 * expected.norm());
    }
}

TEST_P(NeoHookean, PrincipalStretchesAreSingularValues) {
    const Vec2 stretches = principal_stretches(F());
    const Eigen::SelfAdjointEigenSolver<Mat2> squared(F().transpose() * F());
    EXPECT_NEAR(stretches[0], std::sqrt(squared.eigenvalues()[1]), 1e-14);
    EXPECT_NEAR(stretches[1], std::sqrt(squared.eigenvalues()[0]), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(All, NeoHookean, ::testing::ValuesIn(deformations()));

TEST(NeoHookeanLimits, ProjectionDoesSomething) {
    const StretchModes modes = neo_hookean_modes(rotated(0.8, 0.7, 0.1, 1), plane_stress_lame(1, 0.3), true);
    EXPECT_EQ(modes.lift[0], 0);
    EXPECT_EQ(modes.lift[1], 0);
}

TEST(NeoHookeanLimits, CollapsedTriangleCostsWithoutBound) {
    const Lame lame = plane_stress_lame(1, 0.3);
    double before = 0;
    for (double s = 1e-1; s > 1e-12; s /= 10) {
        const double value = neo_hookean_value(rotated(1, s, 0, 1), lame);
        EXPECT_GT(value, before);
        before = value;
    }
    Mat32 collapsed;
    collapsed << 1, 2, 0, 0, 0, 0;
    EXPECT_EQ(neo_hookean_value(collapsed, lame), std::numeric_limits<double>::infinity());
    collapsed(0, 0) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(neo_hookean_value(collapsed, lame), std::numeric_limits<double>::infinity());
}

/// A value from tr C - 2 - 2 ln J would be all round-off here.
TEST(NeoHookeanLimits, TinyStrainsKeepTheirDigits) {
    const Lame lame = plane_stress_lame(1, 0.3);
    for (double strain : {0x1p-10, 0x1p-20, 0x1p-30}) {
        Mat32 F = Mat32::Identity();
        F(0, 0) += strain;
        const double linear = (lame.mu + lame.lambda / 2) * strain * strain;
        EXPECT_NEAR(neo_hookean_value(F, lame) / linear, 1, 2 * strain + 1e-9);
        EXPECT_NEAR(neo_hookean_stress(F, lame)(0, 0) * strain / (2 * linear), 1, 2 * strain + 1e-14);
    }
    Mat32 shear = Mat32::Identity();
    shear(0, 1) = 0x1p-30;
    EXPECT_NEAR(neo_hookean_value(shear, lame) / (lame.mu / 2 * 0x1p-60), 1, 1e-9);
}

/// The series of the value near rest and the logarithm away from it.
TEST(NeoHookeanLimits, ValueIsSmoothAcrossItsBranches) {
    const Lame lame = plane_stress_lame(1, 0.3);
    for (double det : {0.5, 0.9, 1.1}) {
        const auto value = [&](double d) { return neo_hookean_value(rotated(std::sqrt(d), 1, 0, 1), lame); };
        const double slope = (value(det * (1 + 1e-3)) - value(det * (1 - 1e-3))) / (2e-3 * det);
        EXPECT_NEAR(value(det * (1 + 1e-13)), value(det * (1 - 1e-13)), 2e-13 * std::abs(slope) + 1e-15);
    }
}

} // namespace
} // namespace plisse
