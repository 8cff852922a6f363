#include <plisse/energy/pressure.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <energy/shell_fixtures.h>

namespace plisse {
namespace {

using testing::make_icosphere;
using testing::perturbed;

constexpr double pi = std::numbers::pi;

std::vector<Face> reversed(std::vector<Face> faces) {
    for (Face& face : faces)
        std::swap(face[1], face[2]);
    return faces;
}

Positions pressure_gradient(const PressureEnergy& energy, const Positions& x) {
    const VecX gradient = testing::total_gradient(energy, as_vector(x));
    return as_positions(gradient);
}

TEST(Pressure, VolumeOfAnOctahedronIsExact) {
    TriangleMesh mesh;
    mesh.positions.resize(3, 6);
    mesh.positions << 1, -1, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 1, -1;
    for (int x : {0, 1})
        for (int y : {2, 3})
            for (int z : {4, 5}) {
                const bool mirrored = (x == 1) != ((y == 3) != (z == 5));
                mesh.faces.push_back(mirrored ? Face{x, z, y} : Face{x, y, z});
            }
    mesh.positions.colwise() += Vec3(100, -50, 30);
    EXPECT_NEAR(PressureEnergy(mesh.positions, mesh.faces).volume(mesh.positions), 4.0 / 3, 1e-13);
}

TEST(Pressure, VolumeOfSpheresConverges) {
    for (const auto& [times, tolerance] : {std::pair{3, 2e-2}, {4, 5e-3}}) {
        const TriangleMesh sphere = make_icosphere(times);
        const double volume = PressureEnergy(sphere.positions, sphere.faces).volume(sphere.positions);
        EXPECT_NEAR(volume / (4 * pi / 3), 1, tolerance);
        EXPECT_LT(volume, 4 * pi / 3);
    }
}

TEST(Pressure, PushesOutwardWhicheverWayTheFacesTurn) {
    const TriangleMesh sphere = make_icosphere(2);
    const PressureEnergy outward(sphere.positions, sphere.faces, 5);
    const PressureEnergy inward(sphere.positions, reversed(sphere.faces), 5);
    const Positions first = pressure_gradient(outward, sphere.positions);
    const Positions second = pressure_gradient(inward, sphere.positions);
    EXPECT_LT((first - second).cwiseAbs().maxCoeff(), 1e-15);
    for (int v = 0; v < sphere.vertex_count(); ++v)
        EXPECT_LT(first.col(v).dot(sphere.positions.col(v)), 0);
    EXPECT_NEAR(testing::total_value(inward, as_vector(sphere.positions)), -5 * outward.volume(sphere.positions),
                1e-13);
}

/// V is linear in every single coordinate, so long differences are exact.
TEST(Pressure, DerivativesAgreeWithDifferences) {
    const TriangleMesh sphere = make_icosphere(1);
    PressureEnergy energy(sphere.positions, reversed(sphere.faces));
    energy.set_pressure(3);
    const VecX x = as_vector(perturbed(sphere.positions, 0.1));
    const auto value = [&](const VecX& y) { return VecX::Constant(1, testing::total_value(energy, y)).eval(); };
    const auto gradient = [&](const VecX& y) { return testing::total_gradient(energy, y); };
    const VecX exact = gradient(x);
    const Eigen::MatrixXd by_value = testing::central_differences(value, x, 0.1);
    EXPECT_LT((by_value.transpose() - exact).cwiseAbs().maxCoeff(), 1e-9 * exact.cwiseAbs().maxCoeff());
    const Eigen::MatrixXd hessian = testing::total_hessian(energy, x, false);
    const Eigen::MatrixXd by_gradient = testing::central_differences(gradient, x, 0.1);
    EXPECT_LT((by_gradient - hessian).cwiseAbs().maxCoeff(), 1e-9 * hessian.cwiseAbs().maxCoeff());
}

/// dV of a uniform growth is 3 V, and of a motion along the normals the area.
TEST(Pressure, WorkIsThatOfTheDivergenceTheorem) {
    const TriangleMesh sphere = make_icosphere(3);
    const PressureEnergy energy(sphere.positions, sphere.faces, 1);
    const Positions gradient = pressure_gradient(energy, sphere.positions);
    EXPECT_NEAR(-gradient.cwiseProduct(sphere.positions).sum() / (3 * energy.volume(sphere.positions)), 1, 1e-13);
}

TEST(Pressure, ClosedSurfaceFeelsNoNetForce) {
    const TriangleMesh sphere = make_icosphere(3);
    const double p = 1e5;
    const Positions x = perturbed(sphere.positions, 0.05).colwise() + Vec3(3, -2, 1);
    const PressureEnergy energy(sphere.positions, sphere.faces, p);
    const Positions forces = pressure_gradient(energy, x);
    EXPECT_LT(forces.rowwise().sum().norm(), 1e-13 * p * 4 * pi);
    EXPECT_LT((pressure_forces(x, sphere.faces, p) + forces).cwiseAbs().maxCoeff(), 1e-15 * p);
}

TEST(Pressure, ProjectionIsThatOfAGeneralEigenSolver) {
    const TriangleMesh sphere = make_icosphere(0);
    const Positions x = perturbed(sphere.positions, 0.2);
    for (double p : {2.0, -2.0}) {
        const PressureEnergy energy(sphere.positions, sphere.faces, p);
        for (int f = 0; f < energy.element_count(); ++f) {
            Mat9 exact, projected;
            energy.hessian(f, x, false, exact.data());
            energy.hessian(f, x, true, projected.data());
            EXPECT_LT((projected - testing::general_positive_part(exact)).norm(), 1e-12 * exact.norm());
        }
    }
}

TEST(Pressure, OpenBodyIsPushedAlongItsNormals) {
    const TriangleMesh sheet = testing::make_sheet(4, 4, 2, 3, testing::Cells::random, 0.2);
    const Positions forces = pressure_forces(sheet.positions, sheet.faces, 10);
    EXPECT_LT((forces.rowwise().sum() - Vec3(0, 0, 60)).norm(), 1e-12);
}

// ---- P1: inflation of a membrane sphere (VALIDATION.md)

/// p R/(mu t) at which the radial forces of skin and pressure balance in the mean, when the rest sphere grows by
/// `stretch` everywhere; R = 3 V/A of the mesh.
double balancing_pressure(const TriangleMesh& sphere, double nu, double stretch) {
    const Lame lame = plane_stress_lame(1, nu);
    const double thickness = 0.01;
    const MembraneEnergy skin = testing::make_membrane(sphere, lame, thickness);
    const PressureEnergy gas(sphere.positions, sphere.faces, 1);
    const Positions x = stretch * sphere.positions;
    const VecX skin_forces = testing::total_gradient(skin, as_vector(x));
    const double inward = as_positions(skin_forces).cwiseProduct(sphere.positions).sum();
    const double outward = -pressure_gradient(gas, x).cwiseProduct(sphere.positions).sum();
    double area = 0;
    for (double a : skin.triangles().areas())
        area += a;
    const double radius = 3 * gas.volume(sphere.positions) / area;
    return inward / outward * radius / (lame.mu * thickness);
}

struct InflationRow {
    double stretch, without, at_3, at_45;
};

TEST(PressureP1, SphereBalancesAtTheTabulatedPressure) {
    const TriangleMesh coarse = make_icosphere(3), fine = make_icosphere(4);
    ASSERT_EQ(coarse.vertex_count(), 642);
    ASSERT_EQ(fine.vertex_count(), 2562);
    for (const auto& [stretch, without, at_3, at_45] :
         {InflationRow{1.01, .03902, .07213, .10223}, InflationRow{1.1, .31555, .56107, .78426},
          InflationRow{1.2, .50926, .87101, 1.19987}, InflationRow{1.5, .74074, 1.15264, 1.52710},
          InflationRow{2, .75000, 1.04706, 1.31712}, InflationRow{3, .59259, .73210, .85892}})
        for (const auto& [nu, expected] : {std::pair{0.0, without}, {.3, at_3}, {.45, at_45}}) {
            EXPECT_NEAR(balancing_pressure(coarse, nu, stretch), expected, 5e-3 * expected);
            EXPECT_NEAR(balancing_pressure(fine, nu, stretch), expected, 1e-3 * expected);
            const double ratio = plane_stress_lame(1, nu).lambda / plane_stress_lame(1, nu).mu;
            const double cube = stretch * stretch * stretch;
            const double exact = 2 * (1 / stretch - 1 / cube) + 4 * ratio * std::log(stretch) / cube;
            EXPECT_NEAR(balancing_pressure(coarse, nu, stretch), exact, 1e-11) << "exact for any mesh grown evenly";
        }
}

} // namespace
} // namespace plisse
