#include <plisse/energy/membrane.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <energy/shell_fixtures.h>
#include <plisse/energy/loads.h>

namespace plisse {
namespace {

using testing::Cells;
using testing::dense_newton;
using testing::make_membrane;
using testing::make_sheet;
using testing::perturbed;

constexpr double thickness = 0.01;

TriangleMesh irregular_square() {
    return make_sheet(5, 5, 1, 1, Cells::random, 0.2);
}

/// Nominal stress along a principal direction, Pa: the closed form for one stretch given both.
double principal_stress(double along, double across, const Lame& lame) {
    return lame.mu * (along - 1 / along) + lame.lambda * std::log(along * across) / along;
}

/// The lateral stretch at which a strip stretched by `along` carries no lateral stress, by bisection.
double free_lateral_stretch(double along, const Lame& lame) {
    double low = 0.1, high = 3;
    for (int k = 0; k < 200; ++k) {
        const double middle = (low + high) / 2;
        (principal_stress(middle, along, lame) > 0 ? high : low) = middle;
    }
    return (low + high) / 2;
}

/// Forces on the edge x = 1 of the unit square, per thickness and width.
Vec3 edge_stress(const MembraneEnergy& energy, const TriangleMesh& mesh, const Positions& x) {
    const VecX gradient = testing::total_gradient(energy, as_vector(x));
    Vec3 sum = Vec3::Zero();
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.positions(0, v) == 1)
            sum += gradient.segment<3>(3 * v);
    return sum / thickness;
}

struct AffineState {
    Vec3 stress;    ///< P e1
    double density; ///< energy per rest volume
};
AffineState affine_state(const Mat2& map, double nu) {
    const TriangleMesh mesh = irregular_square();
    const MembraneEnergy energy = make_membrane(mesh, plane_stress_lame(1, nu), thickness);
    Positions x = mesh.positions;
    x.topRows<2>() = (map * mesh.positions.topRows<2>()).eval();
    return {edge_stress(energy, mesh, x), testing::total_value(energy, as_vector(x)) / thickness};
}

// ---- M1: homogeneous stretch and shear (VALIDATION.md)

TEST(MembraneM1, EquibiaxialStretch) {
    struct Row {
        double nu, stretch, stress, density;
    };
    for (const auto& [nu, stretch, stress, density] :
         {Row{.3, .9, -.15838, .015289}, Row{.3, 1.01, .01415, .000142}, Row{.3, 1.1, .13056, .013443},
          Row{.3, 1.25, .29078, .077528}, Row{.3, 1.5, .49874, .277270}, Row{.3, 2, .80543, .937438}}) {
        const AffineState state = affine_state(stretch * Mat2::Identity(), nu);
        EXPECT_NEAR(state.stress[0], stress, 6e-6);
        EXPECT_NEAR(state.density, density, 6e-7);
        const double exact = principal_stress(stretch, stretch, plane_stress_lame(1, nu));
        EXPECT_NEAR(state.stress[0] / exact, 1, 1e-10);
        EXPECT_NEAR(state.stress[1], 0, 1e-12);
    }
    for (const auto& [stretch, stress] : {std::pair{1.1, .16361}, {1.25, .35663}, {1.5, .59241}, {2.0, .90836}})
        EXPECT_NEAR(affine_state(stretch * Mat2::Identity(), .45).stress[0], stress, 6e-6);
}

TEST(MembraneM1, StripBiaxialStretch) {
    struct Row {
        double stretch, along, across;
    };
    const Lame lame = plane_stress_lame(1, .3);
    for (const auto& [stretch, along, across] :
         {Row{.9, -.11979, -.03473}, Row{1.1, .10199, .03142}, Row{1.5, .40963, .13367}, Row{2, .69118, .22851}}) {
        const double first = affine_state(Vec2(stretch, 1).asDiagonal(), .3).stress[0];
        const double second = affine_state(Vec2(1, stretch).asDiagonal(), .3).stress[0];
        EXPECT_NEAR(first, along, 6e-6);
        EXPECT_NEAR(second, across, 6e-6);
        EXPECT_NEAR(first / principal_stress(stretch, 1, lame), 1, 1e-10);
        EXPECT_NEAR(second / principal_stress(1, stretch, lame), 1, 1e-10);
    }
}

TEST(MembraneM1, SimpleShear) {
    Mat2 shear;
    shear << 1, .5, 0, 1;
    const AffineState state = affine_state(shear, .3);
    const double mu = plane_stress_lame(1, .3).mu;
    EXPECT_NEAR(state.density, mu * .125, 1e-10 * mu);
    EXPECT_NEAR(state.density, .0480769, 5e-8);
    EXPECT_NEAR(state.stress[0], 0, 1e-12);
    EXPECT_NEAR(state.stress[1] / (mu * .5), 1, 1e-10);
    EXPECT_NEAR(state.stress[1], .192308, 5e-7);
}

/// Left edge on x = 0, right edge pulled, lateral edges free.
TEST(MembraneM1, UniaxialStretchWithFreeLateralEdges) {
    struct Row {
        double nu, along, across, stress;
    };
    const TriangleMesh mesh = irregular_square();
    for (const auto& [nu, along, across, stress] :
         {Row{.3, .80, 1.06604, -.23868}, Row{.3, .90, 1.03141, -.10846}, Row{.3, 1.01, .99701, .00993},
          Row{.3, 1.10, .97124, .09325}, Row{.3, 1.25, .93217, .21340}, Row{.3, 1.50, .87547, .38040},
          Row{.3, 2.00, .78392, .65105}, Row{.45, .80, 1.09978, -.24548}, Row{.45, 1.25, .89924, .20796},
          Row{.45, 2.00, .68916, .60777}, Row{0, 1.5, 1, .416667}}) {
        const Lame lame = plane_stress_lame(1, nu);
        const MembraneEnergy energy = make_membrane(mesh, lame, thickness);
        std::vector<bool> fixed(static_cast<std::size_t>(mesh.positions.size()), false);
        for (std::size_t v = 0; v < fixed.size() / 3; ++v) {
            const Vec3 at = mesh.positions.col(static_cast<int>(v));
            fixed[3 * v] = at[0] == 0 || at[0] == 1;
            fixed[3 * v + 1] = at[0] == 0 && at[1] == 0;
            fixed[3 * v + 2] = true;
        }
        Positions x = mesh.positions;
        x.row(0) *= along;
        ASSERT_TRUE(dense_newton(energy, Positions::Zero(3, mesh.vertex_count()), fixed, x, 1e-13 * thickness));
        const double width = x.row(1).maxCoeff() - x.row(1).minCoeff();
        const double pull = edge_stress(energy, mesh, x)[0];
        EXPECT_NEAR(width, across, 6e-6);
        EXPECT_NEAR(pull, stress, 6e-6);
        const double lateral = free_lateral_stretch(along, lame);
        EXPECT_NEAR(width, lateral, 1e-8);
        EXPECT_NEAR(pull / principal_stress(along, lateral, lame), 1, 1e-8);
    }
}

// ---- M2: exactness set

TEST(MembraneM2, PatchTest) {
    const TriangleMesh mesh = make_sheet(6, 6, 1, 1, Cells::random, 0.2); // 25 inner vertices
    const MembraneEnergy energy = make_membrane(mesh, plane_stress_lame(1, .3), thickness);
    Mat32 map;
    map << 1.3, .2, 0, .9, 0, 0;
    Random random(2);
    const Mat32 placed = testing::random_rotation(random) * map;
    const Positions affine = placed * mesh.positions.topRows<2>();
    // Within the plane: out of it the sheet, pressed together in one direction, has other equilibria.
    const Positions moved = placed * perturbed(mesh.positions, 0.02).topRows<2>();
    Positions x = affine;
    std::vector<bool> fixed(static_cast<std::size_t>(x.size()), true);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3 at = mesh.positions.col(v);
        if (at.head<2>().minCoeff() > 0 && at.head<2>().maxCoeff() < 1) {
            x.col(v) = moved.col(v);
            std::fill_n(fixed.begin() + 3 * v, 3, false);
        }
    }
    ASSERT_EQ(std::count(fixed.begin(), fixed.end(), false), 75);
    ASSERT_GT((x - affine).cwiseAbs().maxCoeff(), 1e-2);
    ASSERT_TRUE(dense_newton(energy, Positions::Zero(3, mesh.vertex_count()), fixed, x, 1e-10 * thickness));
    EXPECT_LT((x - affine).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(MembraneM2, RigidMotionsChangeNothing) {
    const TriangleMesh mesh = irregular_square();
    const MembraneEnergy energy = make_membrane(mesh, plane_stress_lame(1, .3), thickness);
    const Positions x = perturbed(mesh.positions, 0.04);
    const double value = testing::total_value(energy, as_vector(x));
    const VecX gradient = testing::total_gradient(energy, as_vector(x));
    const auto forces = as_positions(gradient);
    Random random(9);
    for (int k = 0; k < 100; ++k) {
        const Mat3 Q = testing::random_rotation(random);
        const Vec3 b(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5));
        const Positions y = (Q * x).colwise() + b;
        EXPECT_NEAR(testing::total_value(energy, as_vector(y)) / value, 1, 1e-13);
        const VecX turned = testing::total_gradient(energy, as_vector(y));
        EXPECT_LT((as_positions(turned) - Q * forces).cwiseAbs().maxCoeff(), 1e-12 * thickness);
    }
    Vec3 moment = Vec3::Zero();
    for (int v = 0; v < mesh.vertex_count(); ++v)
        moment += Vec3(x.col(v)).cross(Vec3(forces.col(v)));
    EXPECT_LT(forces.rowwise().sum().norm(), 1e-12 * thickness);
    EXPECT_LT(moment.norm(), 1e-12 * thickness);
}

TEST(MembraneM2, DerivativesAgreeWithDifferences) {
    const TriangleMesh mesh = make_sheet(3, 3, 1, 1, Cells::random, 0.2);
    const MembraneEnergy energy = make_membrane(mesh, plane_stress_lame(1, .3), thickness);
    Positions squashed = mesh.positions;
    squashed.row(0) *= 0.5;
    squashed.row(1) *= 0.1;
    for (const Positions& x : {mesh.positions, perturbed(mesh.positions, 0.2 / 3), squashed}) {
        const testing::DerivativeErrors errors = testing::derivative_errors(energy, x, 0.1);
        EXPECT_LT(errors.gradient, 1e-7);
        EXPECT_LT(errors.hessian, 1e-6);
    }
}

TEST(MembraneM2, RestHasNoForce) {
    const TriangleMesh mesh = testing::make_icosphere(2);
    const MembraneEnergy energy = make_membrane(mesh, plane_stress_lame(1, .3), thickness);
    EXPECT_LT(testing::total_gradient(energy, as_vector(mesh.positions)).cwiseAbs().maxCoeff(), 1e-14 * thickness);
    EXPECT_LT(testing::total_value(energy, as_vector(mesh.positions)), 1e-28);
}

TEST(MembraneM2, ProjectedHessianIsPositive) {
    const TriangleMesh mesh = make_sheet(3, 3, 1, 1, Cells::random, 0.2);
    const MembraneEnergy energy = make_membrane(mesh, plane_stress_lame(1, .3), thickness);
    const VecX x = as_vector(perturbed(0.8 * mesh.positions, 0.1));
    EXPECT_LT(testing::lowest_eigenvalue(testing::total_hessian(energy, x, false)), -1e-4 * thickness);
    EXPECT_GT(testing::lowest_eigenvalue(testing::total_hessian(energy, x, true)), -1e-13 * thickness);
}

TEST(MembraneM2, CollapsedTriangleIsInfinite) {
    const TriangleMesh mesh = irregular_square();
    const MembraneEnergy energy = make_membrane(mesh, plane_stress_lame(1, .3), thickness);
    Positions x = mesh.positions;
    x.row(0).setZero();
    EXPECT_EQ(testing::total_value(energy, as_vector(x)), std::numeric_limits<double>::infinity());
}

TEST(MembraneM2, LargestStretch) {
    const TriangleMesh mesh = irregular_square();
    const MembraneEnergy energy = make_membrane(mesh, plane_stress_lame(1, .3), thickness);
    Positions x = mesh.positions;
    x.row(0) *= 1.4;
    x.row(1) *= 0.7;
    EXPECT_NEAR(energy.triangles().largest_stretch(x), 1.4, 1e-14);
    for (int f = 0; f < energy.element_count(); ++f)
        EXPECT_LT((energy.triangles().principal_stretches(f, x) - Vec2(1.4, 0.7)).norm(), 1e-14);
}

/// A strip that hangs by its upper edge, free to contract, under its own lumped weight w = rho g L/E.
double hanging_strip_extension(int segments, double w) {
    const int columns = std::max(1, segments / 10);
    const TriangleMesh mesh = make_sheet(columns, segments, 0.1, 1, Cells::alternating);
    const MembraneEnergy energy = make_membrane(mesh, plane_stress_lame(1, .3), thickness);
    const std::vector<double> density(mesh.faces.size(), w), thick(mesh.faces.size(), thickness);
    Positions forces = Positions::Zero(3, mesh.vertex_count());
    add_weight(lumped_masses(mesh.positions, mesh.faces, density, thick), Vec3(0, -1, 0), forces);
    std::vector<bool> fixed(static_cast<std::size_t>(mesh.positions.size()), false);
    for (std::size_t v = 0; v < fixed.size() / 3; ++v) {
        const Vec3 at = mesh.positions.col(static_cast<int>(v));
        fixed[3 * v + 1] = at[1] == 1;
        fixed[3 * v] = at[1] == 1 && at[0] == 0;
        fixed[3 * v + 2] = true;
    }
    Positions x = mesh.positions;
    EXPECT_TRUE(dense_newton(energy, forces, fixed, x, 1e-12 * thickness));
    return -x.row(1).head(columns + 1).mean();
}

TEST(MembraneM2, HangingStrip) {
    for (const auto& [w, extension] : {std::pair{.001, .000500}, {.01, .005025}, {.1, .052573}, {.3, .174144}}) {
        const double rounding = 5e-7 / extension; // of the table
        EXPECT_NEAR(hanging_strip_extension(10, w) / extension, 1, 1e-2 + rounding) << w;
        EXPECT_NEAR(hanging_strip_extension(30, w) / extension, 1, 1e-3 + rounding) << w;
    }
}

} // namespace
} // namespace plisse
