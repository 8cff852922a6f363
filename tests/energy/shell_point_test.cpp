#include <plisse/energy/shell_point.h>

#include <gtest/gtest.h>

#include <energy/shell_fixtures.h>

namespace plisse {
namespace {

/// Unknown r of coordinate a at 5a + r, as in ShellPoint::Hessian.
SurfaceJet as_jet(const VecX& y) {
    return Eigen::Map<const Eigen::Matrix<double, 5, 3>>(y.data()).transpose();
}
VecX as_unknowns(const SurfaceJet& jet) {
    const Eigen::Matrix<double, 5, 3> turned = jet.transpose();
    return Eigen::Map<const VecX>(turned.data(), 15);
}

SurfaceJet sample_jet() {
    SurfaceJet jet;
    jet << 1.1, 0.2, 0.4, -0.9, 1.3, -0.1, 0.9, 2.1, 0.3, -0.8, 0.3, -0.4, 1.7, 1.1, 0.6;
    return jet;
}
const Vec3 rest_curvature(0.3, -0.2, 0.5);

TEST(ShellPoint, MeasuresStrainAndCurvature) {
    // A cylinder of radius 2 about y, stretched by 1.1 along its axis.
    SurfaceJet jet = SurfaceJet::Zero();
    jet.col(0) = Vec3(1, 0, 0);
    jet.col(1) = Vec3(0, 1.1, 0);
    jet.col(2) = Vec3(0, 0, -0.5);
    const ShellPoint point(jet, Vec3::Zero());
    ASSERT_TRUE(point.regular());
    EXPECT_LT((point.strain() - Vec3(0, (1.1 * 1.1 - 1) / 2, 0)).norm(), 1e-15);
    EXPECT_LT((point.curvature() - Vec3(0.5, 0, 0)).norm(), 1e-15);
}

TEST(ShellPoint, IsNotRegularWhereThereIsNoNormal) {
    SurfaceJet jet = sample_jet();
    jet.col(1) = -2 * jet.col(0);
    EXPECT_FALSE(ShellPoint(jet, Vec3::Zero()).regular());
    jet.col(1).setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(ShellPoint(jet, Vec3::Zero()).regular());
}

TEST(ShellPoint, GradientAndHessianAreTheEnergysDerivatives) {
    const ShellSection section(isotropic_material(2, 0.3), 1.4, 3); // so thick that both parts count
    const auto energy = [&](const VecX& y) {
        const ShellPoint point(as_jet(y), rest_curvature);
        return VecX::Constant(1, section.energy(point.strain(), point.curvature())).eval();
    };
    const auto gradient = [&](const VecX& y) {
        const ShellPoint point(as_jet(y), rest_curvature);
        return as_unknowns(point.gradient(section.forces(point.strain(), point.curvature())));
    };
    const VecX at = as_unknowns(sample_jet());
    const ShellPoint point(sample_jet(), rest_curvature);
    const ShellPoint::Hessian hessian = point.hessian(section.tangent(point.strain(), point.curvature(), false), false);
    EXPECT_LT((testing::central_differences(energy, at, 1e-5).transpose() - gradient(at)).norm(),
              1e-9 * gradient(at).norm());
    EXPECT_LT((testing::central_differences(gradient, at, 1e-5) - hessian).norm(), 1e-9 * hessian.norm());
    EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-15 * hessian.norm());
}

TEST(ShellPoint, ProjectedHessianIsPositive) {
    const ShellSection section(isotropic_material(2, 0.3), 1.4, 3);
    SurfaceJet jet = sample_jet();
    jet.leftCols<2>() *= 0.7; // compressed
    const ShellPoint point(jet, rest_curvature);
    const auto hessian = [&](bool project) {
        return point.hessian(section.tangent(point.strain(), point.curvature(), project), project);
    };
    EXPECT_LT(testing::lowest_eigenvalue(hessian(false)), -0.1);
    EXPECT_GT(testing::lowest_eigenvalue(hessian(true)), -1e-13 * hessian(true).norm());
}

} // namespace
} // namespace plisse
