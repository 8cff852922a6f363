#include <plisse/energy/hinge.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <energy/shell_fixtures.h>
#include <plisse/geometry/dihedral.h>

namespace plisse {
namespace {

using testing::Cells;
using testing::make_hinges;
using testing::make_sheet;
using testing::perturbed;

constexpr double pi = std::numbers::pi;

/// A strip of n cells of width s and length `axial` rolled into a closed regular n-gon.
TriangleMesh make_tube(int n, double s, double axial) {
    TriangleMesh mesh;
    mesh.positions.resize(3, 2 * n);
    const double radius = s / (2 * std::sin(pi / n));
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * pi * i / n;
        mesh.positions.col(i) << radius * std::cos(angle), 0, radius * std::sin(angle);
        mesh.positions.col(n + i) = mesh.positions.col(i) + axial * Vec3::UnitY();
        const int next = (i + 1) % n;
        mesh.faces.push_back({i, n + i, n + next});
        mesh.faces.push_back({i, n + next, next});
    }
    return mesh;
}

TriangleMesh make_hinge_mesh(double angle) {
    TriangleMesh mesh;
    mesh.positions.resize(3, 4);
    mesh.positions << 0, 1.1, 0.3, 0.75,   //
        0, 0, 0.8, -0.6 * std::cos(angle), //
        0, 0, 0, -0.6 * std::sin(angle);
    mesh.faces = {{0, 1, 2}, {1, 0, 3}};
    return mesh;
}

// ---- B1: the constant c of W = c D/2 |e|^2/(A1 + A2) (theta - theta_rest)^2

TEST(HingeB1, TubeMeasuresTheDocumentedConstant) {
    const double rigidity = bending_rigidity(7e10, .3, 1e-3);
    EXPECT_NEAR(rigidity, 7e10 * 1e-9 / (12 * .91), 1e-12 * rigidity);
    for (double documented : {1.0, 3.0})
        for (int n : {6, 12, 48}) {
            const double s = 0.2, axial = 0.7;
            const TriangleMesh tube = make_tube(n, s, axial);
            const HingeEnergy energy = make_hinges(tube, documented * rigidity, true);
            const double plate_theory = rigidity / 2 * 4 * pi * pi * axial / (n * s);
            const double c = testing::total_value(energy, as_vector(tube.positions)) / plate_theory;
            EXPECT_NEAR(c, documented, 1e-12 * documented) << n << " cells";
        }
}

/// Twice the energy per area and unit of D of a large lattice under z = x' K x/2 and `ripple` up and down on the
/// vertices in turn, over one period of it.
double energy_density(const TriangleMesh& sheet, const Mat2& curvature, const Vec2& period, double ripple = 0) {
    TriangleMesh bent = sheet;
    const double small = 1e-4;
    const Vec2 centre = sheet.positions.topRows<2>().rowwise().mean();
    for (int v = 0; v < bent.vertex_count(); ++v) {
        const Vec2 at = sheet.positions.col(v).head<2>() - centre;
        bent.positions(2, v) = small * (at.dot(curvature * at) / 2 + (v % 2 == 0 ? ripple : -ripple));
    }
    const HingeEnergy energy = make_hinges(sheet, 1);
    const Vec2 corner = centre + Vec2(0.137, 0.0713);
    double sum = 0;
    for (int h = 0; h < energy.element_count(); ++h) {
        const auto v = energy.vertices(h);
        const Vec2 middle = (sheet.positions.col(v[0]) + sheet.positions.col(v[1])).head<2>() / 2;
        if (((middle - corner).array() >= 0).all() && ((corner + period - middle).array() > 0).all())
            sum += energy.value(h, bent.positions);
    }
    return 2 * sum / (small * small * period.prod());
}

/// The least of it over the ripple, in which it is quadratic.
double relaxed_energy_density(const TriangleMesh& sheet, const Mat2& curvature, const Vec2& period) {
    const double below = energy_density(sheet, curvature, period, -0.1);
    const double middle = energy_density(sheet, curvature, period);
    const double above = energy_density(sheet, curvature, period, 0.1);
    return middle - (above - below) * (above - below) / (8 * (above + below - 2 * middle));
}

Mat2 bend_along(double degrees) {
    const Vec2 direction(std::cos(degrees * pi / 180), std::sin(degrees * pi / 180));
    return direction * direction.transpose();
}

struct LatticeRow {
    const char* name;
    TriangleMesh mesh;
    Vec2 period;
    double (*density)(const TriangleMesh&, const Mat2&, const Vec2&);
    std::array<double, 4> cylinder; ///< 0, 45, 90, 135 degrees
    double sphere, saddle, twist;
};

double plain_energy_density(const TriangleMesh& sheet, const Mat2& curvature, const Vec2& period) {
    return energy_density(sheet, curvature, period);
}

std::vector<LatticeRow> lattices() {
    TriangleMesh equilateral = make_sheet(8, 8, 8, 8);
    for (int v = 0; v < equilateral.vertex_count(); ++v) // diagonals (1, 1) become as long as the sides
        equilateral.positions.col(v) = Vec3(equilateral.positions(0, v) - equilateral.positions(1, v) / 2,
                                            equilateral.positions(1, v) * std::sqrt(.75), 0);
    const double third = 1.0 / 3;
    return {{"equilateral",
             equilateral,
             {1, std::sqrt(3.0)},
             plain_energy_density,
             {1, 1, 1, 1},
             4 * third,
             8 * third,
             8 * third},
            {"one diagonal", make_sheet(8, 8, 8, 8), {1, 1}, plain_energy_density, {1, 3, 1, 1}, 2, 2, 6},
            {"alternating",
             make_sheet(8, 8, 8, 8, Cells::alternating),
             {2, 2},
             relaxed_energy_density,
             {2.5 * third, 4 * third, 2.5 * third, 4 * third},
             4 * third,
             2,
             4}};
}

/// The table of VALIDATION.md section 0.2, for c = 1.
TEST(HingeB1, ModulusMapOfLattices) {
    Mat2 saddle, twist;
    saddle << 1, 0, 0, -1;
    twist << 0, 1, 1, 0;
    for (const LatticeRow& row : lattices()) {
        const auto density = [&](const Mat2& curvature) { return row.density(row.mesh, curvature, row.period); };
        for (std::size_t k = 0; k < 4; ++k) {
            const double degrees = 45 * static_cast<double>(k);
            EXPECT_NEAR(density(bend_along(degrees)), row.cylinder[k], 1e-6) << row.name << " " << degrees;
        }
        EXPECT_NEAR(density(Mat2::Identity()), row.sphere, 1e-6) << row.name;
        EXPECT_NEAR(density(saddle), row.saddle, 1e-6) << row.name;
        EXPECT_NEAR(density(twist), row.twist, 1e-6) << row.name;
    }
}

TEST(HingeB1, CurvedRestIsFreeOfForce) {
    for (const TriangleMesh& mesh : {make_tube(12, .2, .5), testing::make_icosphere(2)}) {
        const HingeEnergy energy = make_hinges(mesh, 1);
        EXPECT_LT(testing::total_value(energy, as_vector(mesh.positions)), 1e-14);
        EXPECT_LT(testing::total_gradient(energy, as_vector(mesh.positions)).cwiseAbs().maxCoeff(), 1e-14);
        const HingeEnergy flat = make_hinges(mesh, 1, true);
        EXPECT_GT(testing::total_value(flat, as_vector(mesh.positions)), 1);
    }
}

// ---- M2 for bending

TEST(HingeM2, DerivativesAgreeWithDifferences) {
    const double degree = pi / 180;
    for (double angle : {0.0, 1e-9, 90 * degree, 179.9 * degree, -179.9 * degree}) {
        const HingeEnergy energy = make_hinges(make_hinge_mesh(0.3), 1);
        const testing::DerivativeErrors errors =
            testing::derivative_errors(energy, make_hinge_mesh(angle).positions, 0.5);
        EXPECT_LT(errors.gradient, 1e-7) << angle;
        EXPECT_LT(errors.hessian, 1e-6) << angle;
    }
    const TriangleMesh sheet = make_sheet(3, 3, 1, 1, Cells::random, 0.2);
    const testing::DerivativeErrors errors =
        testing::derivative_errors(make_hinges(sheet, 1), perturbed(sheet.positions, 0.2 / 3), 0.05);
    EXPECT_LT(errors.gradient, 1e-7);
    EXPECT_LT(errors.hessian, 1e-6);
}

TEST(HingeM2, RigidMotionsChangeNothing) {
    const TriangleMesh sheet = make_sheet(4, 4, 1, 1, Cells::random, 0.2);
    const HingeEnergy energy = make_hinges(sheet, 1);
    const Positions x = perturbed(sheet.positions, 0.05);
    const double value = testing::total_value(energy, as_vector(x));
    Random random(4);
    for (int k = 0; k < 100; ++k) {
        const Vec3 b(random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5));
        const Positions y = (testing::random_rotation(random) * x).colwise() + b;
        EXPECT_NEAR(testing::total_value(energy, as_vector(y)) / value, 1, 1e-13);
    }
}

/// Turned inside out, a crease of 120 degrees is 240 degrees away from rest, not 120.
TEST(HingeM2, EnergyGrowsAllTheWayToInsideOut) {
    const double rest_angle = 2 * pi / 3;
    const HingeEnergy energy = make_hinges(make_hinge_mesh(rest_angle), 1);
    double before = -1;
    for (double angle = rest_angle; angle > -pi; angle -= 0.1) {
        const double value = energy.value(0, make_hinge_mesh(angle).positions);
        EXPECT_GT(value, before);
        before = value;
    }
}

TEST(HingeM2, CollapsedFaceIsInfinite) {
    const HingeEnergy energy = make_hinges(make_hinge_mesh(0), 1);
    Positions x = make_hinge_mesh(0).positions;
    x.col(3) << 2, 0, 0;
    EXPECT_EQ(energy.value(0, x), std::numeric_limits<double>::infinity());
}

// ---- projections

Mat12 element_hessian(const HingeEnergy& energy, const Positions& x, bool project) {
    Mat12 hessian;
    energy.hessian(0, x, project, hessian.data());
    return hessian;
}

class HingeProjection : public ::testing::TestWithParam<double> {
protected:
    const TriangleMesh rest = make_hinge_mesh(0.4);
    const Positions x = make_hinge_mesh(GetParam()).positions;
    Mat12 projected(HingeHessian kind) const { return element_hessian(make_hinges(rest, 1, false, kind), x, true); }
    Mat12 exact() const { return element_hessian(make_hinges(rest, 1), x, false); }
};

TEST_P(HingeProjection, IsPositive) {
    for (HingeHessian kind : {HingeHessian::gauss_newton, HingeHessian::projected})
        EXPECT_GT(testing::lowest_eigenvalue(projected(kind)), -1e-12 * projected(kind).norm());
}

TEST_P(HingeProjection, IsNeverBelowTheExactHessian) {
    EXPECT_GT(testing::lowest_eigenvalue(projected(HingeHessian::projected) - exact()), -1e-12 * exact().norm());
}

/// In the coordinates of the modes, where the projection is an orthogonal one, a general solver finds the same.
TEST_P(HingeProjection, IsThatOfAGeneralEigenSolver) {
    const HingeEnergy energy = make_hinges(rest, 1);
    const double turn = GetParam() - energy.rest_angle(0);
    const double k = 2 * energy.value(0, make_hinge_mesh(energy.rest_angle(0) + 1).positions);
    const Dihedral hinge = dihedral(x.col(0), x.col(1), x.col(2), x.col(3));
    const DihedralModes factors = dihedral_modes(hinge);
    Eigen::MatrixXd reduced = Eigen::MatrixXd::Zero(8, 8);
    for (int b = 0; b < 4; ++b)
        reduced.block<2, 2>(2 * b, 2 * b) = k * turn * factors.curvature[static_cast<std::size_t>(b)];
    reduced(0, 0) += 2 * k;
    const auto pulled = [&](const Eigen::MatrixXd& m) { return Mat12(factors.modes * m * factors.modes.transpose()); };
    EXPECT_LT((exact() - pulled(reduced)).norm(), 1e-12 * exact().norm());
    const Mat12 expected = pulled(testing::general_positive_part(reduced));
    EXPECT_LT((projected(HingeHessian::projected) - expected).norm(), 1e-10 * expected.norm());
}

INSTANTIATE_TEST_SUITE_P(All, HingeProjection, ::testing::Values(0.4, 0.41, 0.0, -1.0, 2.0, 3.1, -3.1));

TEST(HingeProjectionAtRest, IsExactInEveryKind) {
    const TriangleMesh mesh = make_hinge_mesh(0.4);
    const Mat12 exact = element_hessian(make_hinges(mesh, 1), mesh.positions, false);
    for (HingeHessian kind : {HingeHessian::gauss_newton, HingeHessian::projected}) {
        const Mat12 projected = element_hessian(make_hinges(mesh, 1, false, kind), mesh.positions, true);
        EXPECT_LT((projected - exact).norm(), 1e-14 * exact.norm());
    }
}

// ---- joints

TEST(HingeJoint, HasTheDerivativesOfItsValueWhicheverWayFacesTurn) {
    for (int leaves : {3, 4})
        for (int turned = 0; turned < 1 << leaves; ++turned) {
            const TriangleMesh book = testing::turned_leaves(testing::make_book(leaves), turned);
            const Positions x = perturbed(book.positions, 0.1);
            const HingeEnergy energy = make_hinges(book, 1.7);
            EXPECT_EQ(energy.element_count(), 2 * leaves * (leaves - 1) / 2 + 3 * leaves);
            const auto errors = testing::derivative_errors(energy, x, 1);
            EXPECT_LT(errors.gradient, 1e-7) << turned;
            EXPECT_LT(errors.hessian, 1e-6) << turned;
            EXPECT_NEAR(testing::total_value(energy, as_vector(x)),
                        testing::total_value(make_hinges(testing::make_book(leaves), 1.7), as_vector(x)), 1e-13);
            EXPECT_LT(testing::total_value(energy, as_vector(book.positions)), 1e-28);
        }
}

/// Two faces fold about an edge that a rib stands on; nothing holds the rib, so it turns to where the energy is least.
TEST(HingeJoint, AnUnloadedRibLeavesTheOthersTheirStiffness) {
    TriangleMesh panel;
    panel.positions.resize(3, 5);
    panel.positions << 0, 1, 0.4, 0.7, 0.3, /**/ 0, 0, 0.8, -0.5, 0, /**/ 0, 0, 0, 0, 0.3;
    panel.faces = {{0, 1, 2}, {1, 0, 3}};
    TriangleMesh ribbed = panel;
    ribbed.faces.push_back({0, 1, 4});
    const auto bent = [&](double rib) {
        Positions x = panel.positions;
        const Mat3 fold = Eigen::AngleAxisd(0.2, Vec3::UnitX()).toRotationMatrix(),
                   lean = Eigen::AngleAxisd(rib, Vec3::UnitX()).toRotationMatrix();
        x.col(2) = fold * x.col(2);
        x.col(4) = lean * x.col(4);
        return as_vector(x);
    };
    const HingeEnergy alone = make_hinges(panel, 1), joint = make_hinges(ribbed, 1);
    const auto energy = [&](double rib) { return testing::total_value(joint, bent(rib)); };
    const double below = energy(-0.1), middle = energy(0), above = energy(0.1); // a parabola
    const double least = middle - (above - below) * (above - below) / (8 * (above + below - 2 * middle));
    EXPECT_NEAR(least, testing::total_value(alone, bent(0)), 1e-12 * least);
    EXPECT_GT(middle, 1.001 * least);
}

// ---- edges

TEST(InteriorHinges, KnowTheirFacesAndOrientation) {
    const TriangleMesh sphere = testing::make_icosphere(1);
    const Hinges hinges = interior_hinges(Connectivity(sphere.vertex_count(), sphere.faces), sphere.faces);
    EXPECT_EQ(hinges.size(), 3 * sphere.face_count() / 2);
    const HingeEnergy energy = make_hinges(sphere, 1);
    for (int h = 0; h < hinges.size(); ++h) {
        EXPECT_GT(energy.rest_angle(h), 0) << "a convex body with outward normals";
        const auto& v = hinges.vertices[static_cast<std::size_t>(h)];
        for (std::size_t side = 0; side < 2; ++side) {
            const Face& face = sphere.faces[static_cast<std::size_t>(hinges.faces[static_cast<std::size_t>(h)][side])];
            for (int corner : {v[0], v[1], v[2 + side]})
                EXPECT_NE(std::find(face.begin(), face.end(), corner), face.end());
        }
    }
    const TriangleMesh sheet = make_sheet(2, 1, 2, 1);
    EXPECT_EQ(interior_hinges(Connectivity(sheet.vertex_count(), sheet.faces), sheet.faces).size(), 3);
}

} // namespace
} // namespace plisse
