#include <plisse/energy/koiter.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <energy/shell_fixtures.h>
#include <linalg/dense_system.h>
#include <plisse/base/parallel.h>
#include <plisse/mesh/generate.h>

namespace plisse {
namespace {

using testing::Cells;
using testing::make_sheet;
using testing::perturbed;

constexpr double nu = 0.3;

KoiterMaterials uniform_material(const TriangleMesh& mesh, bool flat = false) {
    const auto count = mesh.faces.size();
    return {std::vector<double>(count, 1.0), std::vector<double>(count, nu),
            std::vector<std::uint8_t>(count, flat ? 1 : 0)};
}

TriangleMesh irregular_sheet(double edge_length) {
    GeneratorOptions options;
    options.shape = GeneratorShape::sheet;
    options.size = Vec3(1, 1, 0);
    options.edge_length = edge_length;
    return generate_mesh(options);
}

Eigen::MatrixXd assembled_hessian(KoiterBending& bending, const Positions& x, bool project) {
    NewtonSystem system(std::vector<std::uint8_t>(static_cast<std::size_t>(x.size()), 0), bending.pairs());
    system.set_prescribed_step(VecX::Zero(x.size()));
    bending.place_in(system);
    system.begin({});
    bending.add_hessian(x, system, project);
    return dense(system);
}

VecX gradient_of(const KoiterBending& bending, const VecX& x) {
    Positions gradient = Positions::Zero(3, x.size() / 3);
    bending.add_gradient(as_positions(x), gradient);
    return as_vector(gradient);
}

// ---- Derivatives

/// KoiterFaces with some turns, as an energy of the vertices alone.
class WithTurns : public ElementEnergy {
public:
    explicit WithTurns(const TriangleMesh& mesh)
        : faces_(mesh.positions, mesh.faces, uniform_material(mesh)),
          turns_(perturbed(Positions::Zero(3, faces_.turn_columns()), 0.5)) {}
    int element_count() const override { return faces_.element_count(); }
    std::span<const int> vertices(int face) const override { return faces_.vertices(face); }
    double value(int face, const Positions& x) const override { return faces_.value(face, with_turns(x)); }
    void gradient(int face, const Positions& x, double* gradient) const override {
        faces_.gradient(face, with_turns(x), gradient);
    }
    void hessian(int face, const Positions& x, bool project, double* hessian) const override {
        faces_.hessian(face, with_turns(x), project, hessian);
    }

private:
    Positions with_turns(const Positions& x) const {
        Positions all(3, x.cols() + turns_.cols());
        all << x, turns_;
        return all;
    }
    KoiterFaces faces_;
    Positions turns_;
};

TEST(KoiterFaces, HasTheDerivativesOfItsValue) {
    const TriangleMesh sheet = make_sheet(3, 3, 1, 1, Cells::random, 0.2);
    const auto errors = testing::derivative_errors(WithTurns(sheet), perturbed(sheet.positions, 0.1), 1.0 / 3);
    EXPECT_LT(errors.gradient, 1e-7);
    EXPECT_LT(errors.hessian, 1e-6);
}

TEST(KoiterFaces, CopesWithCornersThatFacesShare) {
    TriangleMesh tetrahedron;
    tetrahedron.positions.resize(3, 4);
    tetrahedron.positions << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    tetrahedron.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    const WithTurns faces(tetrahedron);
    EXPECT_EQ(faces.vertices(0).size(), 4U);
    const auto errors = testing::derivative_errors(faces, perturbed(tetrahedron.positions, 0.1), 1);
    EXPECT_LT(errors.gradient, 1e-7);
    EXPECT_LT(errors.hessian, 1e-6);
}

TEST(KoiterFaces, HasTheDerivativesOfItsValueAtJoints) {
    for (int turned = 0; turned < 8; ++turned) {
        const TriangleMesh book = testing::turned_leaves(testing::make_book(3), turned);
        const auto errors = testing::derivative_errors(WithTurns(book), perturbed(book.positions, 0.1), 1);
        EXPECT_LT(errors.gradient, 1e-7) << turned;
        EXPECT_LT(errors.hessian, 1e-6) << turned;
    }
}

/// Neither which way faces turn nor which of them comes first at a joint makes a difference.
TEST(KoiterBending, KnowsNoFirstFaceOfAJoint) {
    TriangleMesh book = testing::make_book(4);
    const Positions x = perturbed(book.positions, 0.1);
    const auto value = [&](const TriangleMesh& mesh) {
        const KoiterBending bending(mesh.positions, mesh.faces, uniform_material(mesh));
        EXPECT_LT(bending.value(mesh.positions), 1e-26);
        return bending.value(x);
    };
    const double expected = value(book);
    for (int turned = 1; turned < 16; ++turned)
        EXPECT_NEAR(value(testing::turned_leaves(book, turned)), expected, 1e-12 * expected) << turned;
    std::rotate(book.faces.begin(), book.faces.begin() + 5, book.faces.end());
    EXPECT_NEAR(value(book), expected, 1e-12 * expected);
}

TEST(KoiterFaces, ProjectsToNoNegativeEigenvalue) {
    const TriangleMesh sheet = make_sheet(4, 4, 1, 1, Cells::random, 0.2);
    const VecX x = as_vector(perturbed(sheet.positions, 0.1));
    const Eigen::MatrixXd hessian = testing::total_hessian(WithTurns(sheet), x, true);
    EXPECT_GT(testing::lowest_eigenvalue(hessian), -1e-12 * hessian.norm());
}

TEST(KoiterBending, HasTheGradientOfItsValue) {
    const TriangleMesh sheet = make_sheet(4, 3, 1, 1, Cells::random, 0.2);
    const KoiterBending bending(sheet.positions, sheet.faces, uniform_material(sheet));
    const VecX x = as_vector(perturbed(sheet.positions, 0.1));
    const auto value = [&](const VecX& y) { return VecX::Constant(1, bending.value(as_positions(y))).eval(); };
    const Eigen::MatrixXd by_value = testing::central_differences(value, x, 1e-6);
    const VecX gradient = gradient_of(bending, x);
    EXPECT_LT((by_value.transpose() - gradient).cwiseAbs().maxCoeff(), 1e-7 * gradient.cwiseAbs().maxCoeff());
}

TEST(KoiterBending, ItsTurnsAreTheBest) {
    const TriangleMesh sheet = make_sheet(4, 3, 1, 1, Cells::random, 0.2);
    const KoiterBending bending(sheet.positions, sheet.faces, uniform_material(sheet));
    const Positions x = perturbed(sheet.positions, 0.1);
    const double least = bending.value(x);
    for (int e = 0; e < bending.faces().edge_count(); ++e)
        for (double change : {-1e-3, 1e-3}) {
            Positions other = bending.with_turns(x);
            other(e % 3, x.cols() + e / 3) += change;
            EXPECT_GT(testing::total_value(bending.faces(), as_vector(other)), least);
        }
}

/// With the turns held the shell is stiffer than it is, but not by much.
TEST(KoiterBending, ItsHessianIsALittleTooStiffWithTheTurnsHeld) {
    const TriangleMesh sheet = irregular_sheet(0.2);
    KoiterBending bending(sheet.positions, sheet.faces, uniform_material(sheet));
    const VecX rest = as_vector(sheet.positions);
    const auto gradient = [&](const VecX& y) { return gradient_of(bending, y); };
    const Eigen::MatrixXd exact = testing::central_differences(gradient, rest, 1e-5);
    const Eigen::MatrixXd held = assembled_hessian(bending, sheet.positions, true);
    // Of the heights alone, without those that tilt the sheet.
    const int n = sheet.vertex_count();
    std::vector<int> heights;
    for (int v = 0; v < n; ++v)
        heights.push_back(3 * v + 1);
    Eigen::MatrixXd tilts(n, 3);
    tilts << VecX::Ones(n), sheet.positions.row(0).transpose(), sheet.positions.row(2).transpose();
    const Eigen::MatrixXd all = Eigen::HouseholderQR<Eigen::MatrixXd>(tilts).householderQ();
    const Eigen::MatrixXd bent = all.rightCols(n - 3);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ratios(
        bent.transpose() * held(heights, heights) * bent, bent.transpose() * exact(heights, heights) * bent);
    EXPECT_GT(ratios.eigenvalues().minCoeff(), 1 - 1e-5);
    EXPECT_LT(ratios.eigenvalues().maxCoeff(), 3);
}

// ---- Invariance and rest

TEST(KoiterBending, VanishesAtRestAlsoWhenMoved) {
    const TriangleMesh sphere = testing::make_icosphere(2);
    const KoiterBending bending(sphere.positions, sphere.faces, uniform_material(sphere));
    Random random(1);
    const Positions moved = (testing::random_rotation(random) * sphere.positions).colwise() + Vec3(1, 2, 3);
    EXPECT_LT(bending.value(sphere.positions), 1e-26);
    EXPECT_LT(bending.value(moved), 1e-26);
    EXPECT_LT(gradient_of(bending, as_vector(moved)).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(KoiterBending, IsInfiniteWhereAFaceHasNoArea) {
    TriangleMesh sheet = make_sheet(2, 2, 1, 1);
    const KoiterBending bending(sheet.positions, sheet.faces, uniform_material(sheet));
    sheet.positions.col(4) = sheet.positions.col(0);
    EXPECT_EQ(bending.value(sheet.positions), std::numeric_limits<double>::infinity());
}

// ---- Plate theory

/// The patch test: bent to y = x' K x/2, an irregular sheet holds the energy of plate theory and is in equilibrium, but
/// for a margin in which its free edges tell.
TEST(KoiterBending, IsPlateTheoryWhateverTheMeshAndTheCurvature) {
    const TriangleMesh sheet = irregular_sheet(0.05);
    const KoiterBending bending(sheet.positions, sheet.faces, uniform_material(sheet));
    const double small = 1e-4;
    const auto is_inner = [&](int v) {
        return std::max(std::abs(sheet.positions(0, v)), std::abs(sheet.positions(2, v))) < 0.25;
    };
    const Mat2 cylinder{{1, 0}, {0, 0}}, slanted{{0.5, 0.5}, {0.5, 0.5}}, sphere{{1, 0}, {0, 1}},
        saddle{{1, 0}, {0, -1}}, twist{{0, 1}, {1, 0}};
    for (const Mat2& curvature : {cylinder, slanted, sphere, saddle, twist}) {
        Positions x = sheet.positions;
        for (int v = 0; v < sheet.vertex_count(); ++v) {
            const Vec2 at(x(0, v), x(2, v));
            x(1, v) = small * at.dot(curvature * at) / 2;
        }
        const Positions forces = as_positions(gradient_of(bending, as_vector(x)));
        double area = 0, energy = 0, force = 0;
        for (int f = 0; f < sheet.face_count(); ++f) {
            const Face& face = sheet.faces[static_cast<std::size_t>(f)];
            if (!std::all_of(face.begin(), face.end(), is_inner))
                continue;
            const Vec3 a = sheet.positions.col(face[0]), b = sheet.positions.col(face[1]),
                       c = sheet.positions.col(face[2]);
            area += (b - a).cross(c - a).norm() / 2;
            energy += bending.faces().value(f, bending.with_turns(x));
        }
        for (int v = 0; v < sheet.vertex_count(); ++v)
            if (is_inner(v))
                force = std::max(force, std::abs(forces(1, v)));
        const double density = (1 - nu) * curvature.squaredNorm() + nu * curvature.trace() * curvature.trace();
        EXPECT_NEAR(2 * energy / (small * small * area), density, 1e-6 * density) << curvature;
        EXPECT_LT(force, 1e-4 * small) << curvature;
    }
}

TEST(KoiterBending, IsTheSameToTheBitForAnyNumberOfThreads) {
    const TriangleMesh sheet = irregular_sheet(0.03);
    KoiterBending one(sheet.positions, sheet.faces, uniform_material(sheet));
    KoiterBending two(sheet.positions, sheet.faces, uniform_material(sheet));
    const Positions x = perturbed(sheet.positions, 0.005);
    double value;
    VecX gradient;
    {
        const ThreadLimit limit(1);
        value = one.value(x);
        gradient = gradient_of(one, as_vector(x));
    }
    const ThreadLimit limit(2);
    EXPECT_EQ(two.value(x), value);
    EXPECT_EQ(gradient_of(two, as_vector(x)), gradient);
}

} // namespace
} // namespace plisse
