#include <plisse/energy/orthotropic.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include <energy/shell_fixtures.h>

namespace plisse {
namespace {

struct Named {
    const char* name;
    OrthotropicMaterial material;
};
std::vector<Named> all_materials() {
    return {{"table", denim_table()}, {"stable", denim_stable()}, {"isotropic", isotropic_material(1e6, 0.3)}};
}

TEST(ResponseFunction, FirstWeightOfTheTableFollowsFromASlopeOfOne) {
    const OrthotropicMaterial material = denim_table();
    EXPECT_NEAR(material.responses[0].terms()[0].mu, -4617.79, 1e-9);
    EXPECT_NEAR(material.responses[2].terms()[0].mu, 84.882, 1e-9);
    EXPECT_NEAR(material.responses[3].terms()[0].mu, -10.87, 1e-9);
    for (const ResponseFunction& response : material.responses)
        EXPECT_EQ(response.slopes(0).first, 1);
}

TEST(ResponseFunction, IsTheSumOfPowersWithinItsLimit) {
    for (const ResponseFunction& response : denim_table().responses)
        for (double u : {1e-4, 0.003, 0.02, 0.06}) {
            double sum = response.terms().empty() ? u : 0, slope = response.terms().empty() ? 1 : 0, size = 1;
            for (const auto& [mu, alpha] : response.terms()) {
                sum += mu / alpha * (std::pow(1 + u, alpha) - 1);
                slope += mu * std::pow(1 + u, alpha - 1);
                size += std::abs(mu);
            }
            EXPECT_NEAR(response.value(u), sum, 1e-15 * size);
            EXPECT_NEAR(response.slopes(u).first, slope, 1e-13 * size);
        }
}

TEST(ResponseFunction, GoesOnAsAParabolaThatBendsUpward) {
    constexpr double limit = ResponseFunction::limit;
    for (const ResponseFunction& response : denim_table().responses) {
        const auto inside = response.slopes(limit), outside = response.slopes(limit * (1 + 1e-12));
        EXPECT_NEAR(outside.first, inside.first, 1e-9 * (1 + std::abs(inside.first)));
        EXPECT_NEAR(response.value(limit * (1 + 1e-12)), response.value(limit), 1e-12);
        EXPECT_EQ(outside.second, std::max(inside.second, 0.0));
        const auto far = response.slopes(3 * limit), farther = response.slopes(5 * limit);
        EXPECT_EQ(far.second, farther.second);
        EXPECT_NEAR(farther.first - far.first, 2 * limit * far.second, 1e-9 * (1 + std::abs(far.first)));
        EXPECT_NEAR(response.value(5 * limit) - response.value(3 * limit), limit * (far.first + farther.first), 1e-12);
    }
}

TEST(OrthotropicMaterial, StressAndTangentAreTheEnergysDerivatives) {
    Random random(5);
    for (const auto& [name, material] : all_materials())
        for (double size : {0.01, 0.1, 0.22, 0.6}) {
            const Strain strain = Strain::NullaryExpr([&] { return size * random.uniform(-1, 1); });
            const auto [stress, tangent] = material.stress_and_tangent(strain);
            EXPECT_EQ(stress, material.stress(strain)) << name;
            const double scale = tangent.cwiseAbs().maxCoeff(), step = 1e-6;
            const auto energy = [&](const VecX& e) { return VecX::Constant(1, material.energy(e)).eval(); };
            const auto force = [&](const VecX& e) { return VecX(material.stress(e)); };
            EXPECT_LT((testing::central_differences(energy, strain, step).transpose() - stress).norm(),
                      1e-7 * (stress.norm() + scale * size))
                << name << size;
            EXPECT_LT((testing::central_differences(force, strain, step) - tangent).norm(), 1e-6 * scale)
                << name << size;
        }
}

TEST(OrthotropicMaterial, RestTangentOfDenimIsPositiveDefinite) {
    const Mat3 tangent = denim_table().stress_and_tangent(Strain::Zero()).tangent / 1e6;
    EXPECT_NEAR(tangent(0, 0) * tangent(1, 1) - tangent(0, 1) * tangent(1, 0), 22.8, 0.05);
    EXPECT_NEAR(tangent(0, 0), 4.79, 1e-12);
    EXPECT_NEAR(tangent(1, 1), 9.03, 1e-12);
    EXPECT_NEAR(tangent(0, 1), 4.52, 1e-12);
    EXPECT_NEAR(tangent(2, 2), 2 * 2.44, 1e-12);
    EXPECT_EQ(denim_table().energy(Strain::Zero()), 0);
    EXPECT_EQ(denim_table().stress(Strain::Zero()), Vec3::Zero());
}

TEST(OrthotropicMaterial, TableHasASpuriousWell) {
    const OrthotropicMaterial material = denim_table();
    EXPECT_NEAR(material.energy({-0.114, 0.108, 0}), -20.5e3, 0.1e3);
    Strain lowest = Strain::Zero();
    for (double e1 = -0.2; e1 <= 0.2; e1 += 0.001)
        for (double e2 = -0.2; e2 <= 0.2; e2 += 0.001)
            if (e1 < 0 && material.energy({e1, e2, 0}) < material.energy(lowest))
                lowest = {e1, e2, 0};
    EXPECT_NEAR(lowest[0], -0.114, 2e-3);
    EXPECT_NEAR(lowest[1], 0.108, 2e-3);
}

/// Least energy of a grid of strains up to 0.2.
double least_energy(const OrthotropicMaterial& material) {
    double least = 0;
    for (int i = -40; i <= 40; ++i)
        for (int j = -40; j <= 40; ++j)
            for (int k = 0; k <= 4; ++k)
                least = std::min(least, material.energy({0.005 * i, 0.005 * j, 0.05 * k}));
    return least;
}

TEST(OrthotropicMaterial, StableDenimsEnergyIsNotNegative) {
    EXPECT_EQ(least_energy(denim_stable()), 0);
    OrthotropicMaterial most_mixed = denim_table();
    most_mixed.stiffness[1] = 2.41e6;
    EXPECT_GE(least_energy(most_mixed), -1e-6);
    most_mixed.stiffness[1] = 2.6e6;
    EXPECT_LT(least_energy(most_mixed), -10);
}

TEST(OrthotropicMaterial, IsBoundedFromBelowFarOut) {
    for (const auto& [name, material] :
         {Named{"stable", denim_stable()}, Named{"isotropic", isotropic_material(1, 0.3)}})
        for (double angle = 0; angle < 6.3; angle += 0.1)
            for (double size : {0.3, 0.5, 1.0, 3.0})
                EXPECT_GT(material.energy(size * Strain(std::cos(angle), std::sin(angle), 0.1)), 0) << name << size;
}

TEST(OrthotropicMaterial, IsotropicIsStVenantKirchhoffInPlaneStress) {
    const double young = 2e5, poisson = 0.35;
    const OrthotropicMaterial material = isotropic_material(young, poisson);
    EXPECT_NEAR(material.stress({0.1, -poisson * 0.1, 0})[0], young * 0.1, 1e-9 * young);
    EXPECT_NEAR(material.stress({0.1, -poisson * 0.1, 0})[1], 0, 1e-10 * young);
    // The same energy in a frame turned by an angle.
    const double c = std::cos(0.7), s = std::sin(0.7);
    Mat2 strain, turn;
    strain << 0.3, 0.07, 0.07, -0.1;
    turn << c, -s, s, c;
    const Mat2 turned = turn.transpose() * strain * turn;
    EXPECT_NEAR(material.energy({turned(0, 0), turned(1, 1), turned(0, 1)}) / material.energy({0.3, -0.1, 0.07}), 1,
                1e-13);
}

} // namespace
} // namespace plisse
