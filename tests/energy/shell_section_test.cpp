#include <plisse/energy/shell_section.h>

#include <gtest/gtest.h>

#include <energy/shell_fixtures.h>

namespace plisse {
namespace {

constexpr double thickness = 6.6e-4;

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

Mat6 whole(const ShellSection::Tangent& tangent) {
    Mat6 matrix;
    matrix << tangent.membrane, tangent.coupling, tangent.coupling, tangent.bending;
    return matrix;
}

/// Strain and curvature with one scale, so that neither's derivatives drown.
ShellSection::Forces forces(const ShellSection& section, const VecX& both) {
    return section.forces(both.head<3>(), both.tail<3>() / thickness);
}
VecX scaled(const ShellSection::Forces& forces) {
    VecX both(6);
    both << forces.membrane, forces.bending / thickness;
    return both;
}

TEST(ShellSection, ForcesAndTangentAreTheEnergysDerivatives) {
    Random random(11);
    for (const OrthotropicMaterial& material : {denim_table(), denim_stable(), isotropic_material(1e6, 0.3)})
        for (int points : {3, 5}) {
            const ShellSection section(material, thickness, points);
            const VecX at = VecX::NullaryExpr(6, [&] { return 0.03 * random.uniform(-1, 1); });
            const auto energy = [&](const VecX& y) {
                return VecX::Constant(1, section.energy(y.head<3>(), y.tail<3>() / thickness)).eval();
            };
            const auto gradient = [&](const VecX& y) { return scaled(forces(section, y)); };
            const auto tangent = section.tangent(at.head<3>(), at.tail<3>() / thickness, false);
            Mat6 matrix = whole(tangent);
            matrix.rightCols<3>() /= thickness;
            matrix.bottomRows<3>() /= thickness;
            const double scale = matrix.norm();
            EXPECT_LT((scaled(tangent.forces) - gradient(at)).norm(), 1e-14 * scale);
            EXPECT_LT((testing::central_differences(energy, at, 1e-6).transpose() - gradient(at)).norm(),
                      1e-7 * gradient(at).norm());
            EXPECT_LT((testing::central_differences(gradient, at, 1e-6) - matrix).norm(), 1e-6 * scale);
        }
}

TEST(ShellSection, ProjectedTangentIsPositiveAndUnchangedWhereItWas) {
    const ShellSection section(denim_table(), thickness, 3);
    const auto unstable = section.tangent({-0.1, 0.1, 0.02}, {20, -30, 10}, false);
    EXPECT_LT(testing::lowest_eigenvalue(whole(unstable)), 0);
    const Mat6 projected = whole(section.tangent({-0.1, 0.1, 0.02}, {20, -30, 10}, true));
    EXPECT_GT(testing::lowest_eigenvalue(projected), -1e-12 * projected.norm());
    const Mat6 near_rest = whole(section.tangent({1e-3, 1e-3, 0}, {1, 1, 1}, false));
    EXPECT_LT((near_rest - whole(section.tangent({1e-3, 1e-3, 0}, {1, 1, 1}, true))).norm(), 1e-13 * near_rest.norm());
}

/// Energy of pure bending of the weft by a fine midpoint rule.
double fine_bending_energy(const OrthotropicMaterial& material, double curvature) {
    constexpr int count = 20000;
    double sum = 0;
    for (int i = 0; i < count; ++i)
        sum += thickness / count * material.energy({0, curvature * thickness * ((i + 0.5) / count - 0.5), 0});
    return sum;
}

TEST(ShellSection, FivePointsIntegrateWhatThreeMiss) {
    const OrthotropicMaterial material = denim_stable();
    const auto error = [&](int points, double curvature) {
        const double exact = fine_bending_energy(material, curvature);
        return std::abs(ShellSection(material, thickness, points).energy(Vec3::Zero(), {0, curvature, 0}) / exact - 1);
    };
    EXPECT_NEAR(error(3, 20), 0.002, 0.0005);
    EXPECT_NEAR(error(3, 50), 0.037, 0.0005);
    EXPECT_LT(error(5, 20), 3e-6);
    EXPECT_NEAR(error(5, 50), 0.0013, 0.00005);
}

TEST(ShellSection, LinearMaterialGivesThePlate) {
    const double young = 1e6, poisson = 0.3;
    const double rigidity = young * std::pow(thickness, 3) / (12 * (1 - poisson * poisson));
    for (int points : {3, 5}) {
        const ShellSection section(isotropic_material(young, poisson), thickness, points);
        EXPECT_NEAR(section.energy(Vec3::Zero(), {3, 0, 0}) / (rigidity / 2 * 9), 1, 1e-13);
        EXPECT_NEAR(section.energy(Vec3::Zero(), {3, 3, 0}) / (rigidity * (1 + poisson) * 9), 1, 1e-13);
        EXPECT_NEAR(section.energy(Vec3::Zero(), {0, 0, 3}) / (rigidity * (1 - poisson) * 9), 1, 1e-13);
        EXPECT_LT(section.tangent(Vec3::Zero(), Vec3::Zero(), false).coupling.norm(), 1e-15 * young * thickness);
    }
}

} // namespace
} // namespace plisse
