#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>

#include <plisse/base/random.h>
#include <plisse/transfer/galerkin.h>
#include <plisse/transfer/prolongation.h>

#include "linalg/dense_system.h"

using namespace plisse;

namespace {

/// A bent coarse grid of rows x 3 vertices with fine vertices scattered over its faces, off the surface.
struct Patch {
    Positions coarse_rest;
    std::vector<Face> faces;
    std::vector<Anchor> anchors;
    Positions fine_rest;
    Random random{7};

    explicit Patch(int fine_count, bool flat = false, int rows = 3) : coarse_rest(3, 3 * rows) {
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < 3; ++j)
                coarse_rest.col(3 * i + j) = Vec3(i + 0.1 * j, flat ? 0.0 : 0.3 * i * i - 0.2 * j * i, j);
        for (int i = 0; i + 1 < rows; ++i)
            for (int j = 0; j < 2; ++j) {
                const int a = 3 * i + j;
                faces.push_back({a, a + 1, a + 4});
                faces.push_back({a, a + 4, a + 3});
            }
        fine_rest.resize(3, fine_count);
        for (int v = 0; v < fine_count; ++v) {
            Anchor anchor;
            anchor.face = random.below(static_cast<int>(faces.size()));
            anchor.weights = Vec3(random.uniform(), random.uniform(), random.uniform());
            anchor.weights /= anchor.weights.sum();
            const Face& face = faces[static_cast<std::size_t>(anchor.face)];
            fine_rest.col(v) = Vec3::Zero();
            for (int k = 0; k < 3; ++k)
                fine_rest.col(v) += anchor.weights[k] * coarse_rest.col(face[static_cast<std::size_t>(k)]);
            if (!flat)
                fine_rest.col(v) += noise(0.1);
            anchors.push_back(anchor);
        }
    }
    Vec3 noise(double size) { return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); }
    Positions deformed(double size) {
        Positions x = coarse_rest;
        for (int v = 0; v < x.cols(); ++v)
            x.col(v) += noise(size);
        return x;
    }
    /// In place of affine, some linear operator.
    Prolongation prolongation(ProlongationOperator kind = ProlongationOperator::shell) const {
        if (kind == ProlongationOperator::affine)
            return {some_weights(), faces, anchors, fine_rest};
        return {coarse_rest, faces, anchors, fine_rest, kind};
    }
    /// Four or fewer in a row, which sum to 1.
    ProlongationWeights some_weights() const {
        ProlongationWeights weights(fine_rest.cols(), coarse_rest.cols());
        std::vector<Eigen::Triplet<double>> entries;
        for (int i = 0; i < weights.rows(); ++i)
            for (int k = 0; k < 4; ++k)
                entries.emplace_back(i, (i * (k + 1) + k) % static_cast<int>(coarse_rest.cols()), k == 3 ? -0.2 : 0.4);
        weights.setFromTriplets(entries.begin(), entries.end());
        return weights;
    }
};

constexpr std::array all_kinds{ProlongationOperator::shell, ProlongationOperator::intrinsic,
                               ProlongationOperator::blend, ProlongationOperator::affine};

class Operators : public testing::TestWithParam<ProlongationOperator> {
protected:
    bool keeps_rest() const {
        return GetParam() == ProlongationOperator::shell || GetParam() == ProlongationOperator::blend;
    }
};
std::string name_of(const testing::TestParamInfo<ProlongationOperator>& tested) {
    constexpr std::array names{"shell", "intrinsic", "blend", "linear"};
    return names[static_cast<std::size_t>(tested.param)];
}
INSTANTIATE_TEST_SUITE_P(All, Operators, testing::ValuesIn(all_kinds), name_of);

/// J as a dense matrix.
Eigen::MatrixXd dense(const Prolongation& p, const Positions& x) {
    const ProlongationJacobian jacobian = p.jacobian(x);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * p.fine_count(), 3 * p.coarse_count());
    for (int i = 0; i < p.fine_count(); ++i) {
        const auto stencil = p.stencils().of(i);
        for (std::size_t k = 0; k < stencil.size(); ++k)
            matrix.block<3, 3>(3 * i, 3 * stencil[k]) = jacobian.rows(i).middleCols<3>(3 * static_cast<int>(k));
    }
    return matrix;
}

TEST_P(Operators, RecoverTheRestShapeWhereTheyHaveArms) {
    const Patch patch(50);
    const double error =
        (patch.prolongation(GetParam()).apply(patch.coarse_rest) - patch.fine_rest).cwiseAbs().maxCoeff();
    EXPECT_EQ(error < 1e-14, keeps_rest());
}

TEST_P(Operators, FollowRigidMotion) {
    Patch patch(50);
    const Prolongation p = patch.prolongation(GetParam());
    const Mat3 q = Eigen::Quaterniond(0.3, -0.5, 0.8, 0.1).normalized().toRotationMatrix();
    const Vec3 shift(1, -2, 3);
    const Positions x = patch.deformed(0.2);
    const Positions moved = (q * x).colwise() + shift;
    const Positions expected = (q * p.apply(x)).colwise() + shift;
    EXPECT_LT((p.apply(moved) - expected).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Prolongation, KeepsAFlatSheetThatIsStretchedEvenly) {
    Mat3 stretch;
    stretch << 1.3, 0.2, 0.1, -0.1, 1, 0.4, 0.2, 0.3, 0.8;
    Patch patch(50, true);
    for (const auto kind :
         {ProlongationOperator::shell, ProlongationOperator::intrinsic, ProlongationOperator::blend}) {
        const Prolongation p = patch.prolongation(kind);
        EXPECT_LT((p.apply(stretch * patch.coarse_rest) - stretch * patch.fine_rest).cwiseAbs().maxCoeff(), 1e-14);
    }
}

TEST(Prolongation, IsBarycentricOnAFlatSheet) {
    Patch patch(50, true);
    const Positions x = patch.deformed(0.3);
    const Positions straight = patch.prolongation(ProlongationOperator::intrinsic).apply(x);
    EXPECT_LT((patch.prolongation().apply(x) - straight).cwiseAbs().maxCoeff(), 1e-14);
}

TEST_P(Operators, JacobianMatchesCentralDifferences) {
    Patch patch(30);
    const Prolongation p = patch.prolongation(GetParam());
    const Positions x = patch.deformed(0.2);
    const Eigen::MatrixXd jacobian = dense(p, x);
    const double h = 1e-6;
    double error = 0;
    for (int v = 0; v < 9; ++v)
        for (int axis = 0; axis < 3; ++axis) {
            Positions plus = x, minus = x;
            plus(axis, v) += h;
            minus(axis, v) -= h;
            const VecX difference = ((p.apply(plus) - p.apply(minus)) / (2 * h)).reshaped();
            error = std::max(error, (difference - jacobian.col(3 * v + axis)).cwiseAbs().maxCoeff());
        }
    EXPECT_LT(error, 1e-6 * jacobian.cwiseAbs().maxCoeff());
}

TEST_P(Operators, PullBackIsTheTransposeOfTheJacobian) {
    Patch patch(40);
    const Prolongation p = patch.prolongation(GetParam());
    const Positions x = patch.deformed(0.2);
    Positions g(3, 40);
    for (int i = 0; i < 40; ++i)
        g.col(i) = patch.noise(1);
    const VecX expected = dense(p, x).transpose() * g.reshaped();
    EXPECT_LT((p.pull_back(x, g).reshaped() - expected).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((p.pull_back_lagged(g).rowwise().sum() - g.rowwise().sum()).norm(), 1e-13);
}

/// A flat strip wound into a part of a cylinder: shell leaves it straight between coarse edges.
TEST(Prolongation, BlendBulgesBetweenFacesAtAnAngle) {
    constexpr int rows = 9;
    constexpr double radius = 2.5;
    Patch patch(400, true, rows);
    Positions wound(3, 3 * rows);
    for (int v = 0; v < wound.cols(); ++v) {
        const double angle = patch.coarse_rest(0, v) / radius;
        wound.col(v) = Vec3(radius * std::sin(angle), radius * std::cos(angle), patch.coarse_rest(2, v));
    }
    const auto worst_distance = [&](ProlongationOperator kind) {
        const Positions fine = patch.prolongation(kind).apply(wound);
        double worst = 0;
        for (int i = 0; i < fine.cols(); ++i)
            if (const double x = patch.fine_rest(0, i); x > 1.2 && x < rows - 2.2) // off the ends, where nothing turns
                worst = std::max(worst, std::abs(std::hypot(fine(0, i), fine(1, i)) - radius));
        return worst;
    };
    EXPECT_LT(worst_distance(ProlongationOperator::blend), 0.25 * worst_distance(ProlongationOperator::shell));
}

TEST(Prolongation, CollapsedTrianglesGiveFinitePositions) {
    const Patch patch(20);
    const Prolongation p = patch.prolongation();
    Positions x = patch.coarse_rest;
    x.row(2).setZero(); // every triangle becomes a line or a point
    x.row(1).setZero();
    EXPECT_TRUE(p.apply(x).allFinite());
    x.setZero();
    EXPECT_TRUE(p.apply(x).allFinite());
}

TEST(Prolongation, ConservesTotalValues) {
    const Patch patch(40);
    const VecX masses = VecX::LinSpaced(40, 1, 2);
    const VecX coarse = patch.prolongation().pull_back_values(masses);
    EXPECT_NEAR(coarse.sum(), masses.sum(), 1e-12);
    EXPECT_GE(coarse.minCoeff(), 0);
}

TEST_P(Operators, GalerkinProductEqualsTheDenseTripleProduct) {
    Patch patch(40);
    const Prolongation p = patch.prolongation(GetParam());
    const Positions x = patch.deformed(0.2);
    std::vector<std::vector<int>> elements;
    std::vector<Eigen::MatrixXd> hessians;
    Eigen::MatrixXd fine = Eigen::MatrixXd::Zero(120, 120);
    for (int e = 0; e < 60; ++e) {
        std::vector<int> vertices;
        while (static_cast<int>(vertices.size()) < 3 + e % 2) {
            const int v = patch.random.below(40);
            if (std::find(vertices.begin(), vertices.end(), v) == vertices.end())
                vertices.push_back(v);
        }
        const int rows = 3 * static_cast<int>(vertices.size());
        Eigen::MatrixXd a(rows, rows);
        for (double& entry : a.reshaped())
            entry = patch.random.uniform(-1, 1);
        const Eigen::MatrixXd h = a * a.transpose();
        for (std::size_t i = 0; i < vertices.size(); ++i)
            for (std::size_t j = 0; j < vertices.size(); ++j)
                fine.block<3, 3>(3 * vertices[i], 3 * vertices[j]) +=
                    h.block<3, 3>(3 * static_cast<int>(i), 3 * static_cast<int>(j));
        elements.push_back(vertices);
        hessians.push_back(h);
    }
    const Eigen::MatrixXd jacobian = dense(p, x);
    const Eigen::MatrixXd expected = jacobian.transpose() * fine * jacobian;

    std::vector<Edge> pairs;
    for (const auto& vertices : elements)
        for (int v : vertices)
            for (int w : vertices)
                if (v < w)
                    pairs.push_back({v, w});
    GalerkinProduct product(p.stencils(), p.coarse_count(), pairs);
    NewtonSystem fine_system(std::vector<std::uint8_t>(120, 0), product.fine_pairs());
    fine_system.begin({});
    for (std::size_t e = 0; e < elements.size(); ++e)
        fine_system.add(elements[e], hessians[e]);
    NewtonSystem system(std::vector<std::uint8_t>(27, 0), product.pairs());
    product.place_in(system);
    system.begin({});
    product.add(p.jacobian(x), fine_system, system);
    const Eigen::MatrixXd actual = dense(system);
    EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
}

} // namespace
