#include <plisse/energy/loads.h>

#include <gtest/gtest.h>

#include <energy/shell_fixtures.h>

namespace plisse {
namespace {

using testing::Cells;
using testing::make_sheet;

TriangleMesh sheet() {
    return make_sheet(5, 4, 2, 3, Cells::random, 0.2);
}

TEST(Loads, MassIsThatOfTheSheet) {
    const TriangleMesh mesh = sheet();
    const std::vector<double> density(mesh.faces.size(), 470), thickness(mesh.faces.size(), 3e-4);
    const double mass = 470 * 3e-4 * 6;
    const VecX masses = lumped_masses(mesh.positions, mesh.faces, density, thickness);
    EXPECT_NEAR(masses.sum() / mass, 1, 1e-14);
    EXPECT_GT(masses.minCoeff(), 0);
    Positions forces = Positions::Zero(3, mesh.vertex_count());
    add_weight(masses, Vec3(0, -9.81, 0.5), forces);
    EXPECT_LT((forces.rowwise().sum() - mass * Vec3(0, -9.81, 0.5)).norm(), 1e-13 * mass);
    EXPECT_NEAR(forces(1, 7), -9.81 * masses[7], 1e-15);
}

TEST(Loads, MassFollowsEachFace) {
    TriangleMesh mesh = make_sheet(1, 1, 1, 1); // faces (0, 1, 3) and (0, 3, 2)
    const std::vector<double> density{600, 1200}, thickness{0.1, 0.2};
    const VecX masses = lumped_masses(mesh.positions, mesh.faces, density, thickness);
    EXPECT_NEAR(masses[1], 10, 1e-13);
    EXPECT_NEAR(masses[2], 40, 1e-13);
    EXPECT_NEAR(masses[0], 50, 1e-13);
    EXPECT_NEAR(masses[3], 50, 1e-13);
}

TEST(Loads, ForceIsSharedOutByArea) {
    const TriangleMesh mesh = sheet();
    const VecX areas = vertex_areas(mesh.positions, mesh.faces);
    EXPECT_NEAR(areas.sum(), 6, 1e-14);
    Positions forces = Positions::Zero(3, mesh.vertex_count());
    const std::vector<int> chosen{0, 8, 9};
    add_shared_force(areas, chosen, Vec3(1, -2, 3), forces);
    EXPECT_LT((forces.rowwise().sum() - Vec3(1, -2, 3)).norm(), 1e-14);
    EXPECT_NEAR(forces(2, 8) / forces(2, 9), areas[8] / areas[9], 1e-14);
    EXPECT_EQ(forces.col(3).norm(), 0);
}

TEST(Loads, ForceOnVerticesWithoutFacesIsSharedOutEvenly) {
    Positions forces = Positions::Zero(3, 3);
    add_shared_force(VecX::Zero(3), std::vector<int>{0, 2}, Vec3(4, 0, 0), forces);
    EXPECT_EQ(forces(0, 0), 2);
    EXPECT_EQ(forces(0, 2), 2);
}

TEST(Loads, TractionActsOnRestArea) {
    const TriangleMesh mesh = sheet();
    std::vector<int> all;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        all.push_back(v);
    Positions forces = Positions::Zero(3, mesh.vertex_count());
    add_traction(vertex_areas(mesh.positions, mesh.faces), all, Vec3(0, 2, 0), forces);
    EXPECT_NEAR(forces.row(1).sum(), 12, 1e-13);
}

TEST(Loads, EnergyIsMinusForceTimesPosition) {
    Positions forces(3, 2), x(3, 2);
    forces << 1, 2, 0, 0, 3, 0;
    x << 5, 1, 7, 7, 2, 9;
    EXPECT_EQ(dead_load_energy(forces, x), -(5 + 2 + 6));
}

} // namespace
} // namespace plisse
