#include <plisse/geometry/dihedral.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace plisse {
namespace {

constexpr double degree = std::numbers::pi / 180;

/// Two unequal triangles on a slanted edge, folded by `angle`.
Vec12 hinge_at(double angle) {
    const Vec3 edge(1.1, 0, 0);
    const Vec3 first(0.3, 0.8, 0);
    const Vec3 second = Eigen::AngleAxisd(angle, Vec3::UnitX()) * Vec3(0.75, -0.6, 0);
    const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -0.5).normalized()).matrix();
    const Vec3 shift(0.2, -0.1, 0.3);
    Vec12 x;
    Eigen::Map<Positions> points(x.data(), 3, 4);
    points << Vec3::Zero(), edge, first, second;
    points = ((turn * points).colwise() + shift).eval();
    return x;
}

double angle_of(const Vec12& x) {
    return dihedral_angle(x.segment<3>(0), x.segment<3>(3), x.segment<3>(6), x.segment<3>(9));
}

Dihedral dihedral_of(const Vec12& x) {
    return dihedral(x.segment<3>(0), x.segment<3>(3), x.segment<3>(6), x.segment<3>(9));
}

class DihedralAngles : public ::testing::TestWithParam<double> {};

TEST_P(DihedralAngles, AngleIsTheOneFoldedBy) {
    EXPECT_NEAR(angle_of(hinge_at(GetParam())), GetParam(), 1e-15);
    EXPECT_NEAR(dihedral_of(hinge_at(GetParam())).angle, GetParam(), 1e-15);
}

TEST_P(DihedralAngles, GradientAgreesWithDifferences) {
    const Vec12 x = hinge_at(GetParam());
    const Vec12 gradient = dihedral_gradient(dihedral_of(x));
    const double step = 1e-5;
    for (int k = 0; k < 12; ++k) {
        const Vec12 move = step * Vec12::Unit(k);
        const double difference = (angle_of(x + move) - angle_of(x - move)) / (2 * step);
        EXPECT_NEAR(gradient[k], difference, 1e-7) << "unknown " << k;
    }
}

TEST_P(DihedralAngles, HessianAgreesWithDifferences) {
    const Vec12 x = hinge_at(GetParam());
    const Mat12 hessian = dihedral_hessian(dihedral_of(x));
    EXPECT_LT((hessian - hessian.transpose()).cwiseAbs().maxCoeff(), 1e-13);
    const double step = 1e-5;
    for (int k = 0; k < 12; ++k) {
        const Vec12 move = step * Vec12::Unit(k);
        const Vec12 difference =
            (dihedral_gradient(dihedral_of(x + move)) - dihedral_gradient(dihedral_of(x - move))) / (2 * step);
        EXPECT_LT((hessian.col(k) - difference).cwiseAbs().maxCoeff(), 1e-6 * hessian.cwiseAbs().maxCoeff());
    }
}

TEST_P(DihedralAngles, RigidMotionsLeaveTheAngle) {
    const Vec12 x = hinge_at(GetParam());
    const Vec12 gradient = dihedral_gradient(dihedral_of(x));
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
        force += gradient.segment<3>(3 * k);
        moment += Vec3(x.segment<3>(3 * k)).cross(Vec3(gradient.segment<3>(3 * k)));
    }
    EXPECT_LT(force.norm(), 1e-14);
    EXPECT_LT(moment.norm(), 1e-14);
}

TEST_P(DihedralAngles, FirstModeIsTheGradient) {
    const Dihedral hinge = dihedral_of(hinge_at(GetParam()));
    const Vec12 mode = -std::numbers::sqrt2 * dihedral_modes(hinge).modes.col(0);
    EXPECT_LT((mode - dihedral_gradient(hinge)).norm(), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(All, DihedralAngles,
                         ::testing::Values(0.0, 1e-9, -1e-9, 90 * degree, -90 * degree, 179.9 * degree, -179.9 * degree,
                                           30 * degree));

TEST(Dihedral, IsTheSameFromEitherFace) {
    const Vec12 x = hinge_at(0.9);
    const Vec3 x0 = x.segment<3>(0), x1 = x.segment<3>(3), x2 = x.segment<3>(6), x3 = x.segment<3>(9);
    EXPECT_NEAR(dihedral_angle(x1, x0, x3, x2), dihedral_angle(x0, x1, x2, x3), 1e-15);
    EXPECT_NEAR(dihedral_angle(x0, x1, x3, x2), -dihedral_angle(x0, x1, x2, x3), 1e-15);
}

TEST(Dihedral, FoldedOntoItselfIsHalfATurn) {
    EXPECT_DOUBLE_EQ(std::abs(dihedral_angle({0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.25, 0.5, 0})), std::numbers::pi);
}

TEST(Dihedral, HasNoAngleWithoutAnArea) {
    EXPECT_TRUE(std::isnan(dihedral_angle({0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {2, 0, 0})));
}

} // namespace
} // namespace plisse
