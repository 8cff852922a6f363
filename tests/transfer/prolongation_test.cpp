#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>

#include <plisse/base/random.h>
#include <plisse/transfer/galerkin.h>

#include "linalg/dense_system.h"

using namespace plisse;

namespace {

/// A bent 3x3 coarse grid with fine vertices scattered over its faces, off the surface.
struct Patch {
    Positions coarse_rest{3, 9};
    std::vector<Face> faces;
    std::vector<Anchor> anchors;
    Positions fine_rest;
    Random random{7};

    explicit Patch(int fine_count, bool flat = false) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                coarse_rest.col(3 * i + j) = Vec3(i + 0.1 * j, flat ? 0.0 : 0.3 * i * i - 0.2 * j * i, j);
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j) {
                const int a = 3 * i + j;
                faces.push_back({a, a + 1, a + 4});
                faces.push_back({a, a + 4, a + 3});
            }
        fine_rest.resize(3, fine_count);
        for (int v = 0; v < fine_count; ++v) {
            Anchor anchor;
            anchor.face = random.below(8);
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
    Prolongation prolongation() const { return {coarse_rest, faces, anchors, fine_rest}; }
};

TEST(Prolongation, RecoversTheRestShape) {
    const Patch patch(50);
    EXPECT_LT((patch.prolongation().apply(patch.coarse_rest) - patch.fine_rest).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Prolongation, FollowsRigidMotion) {
    Patch patch(50);
    const Prolongation p = patch.prolongation();
    const Mat3 q = Eigen::Quaterniond(0.3, -0.5, 0.8, 0.1).normalized().toRotationMatrix();
    const Vec3 shift(1, -2, 3);
    const Positions x = patch.deformed(0.2);
    const Positions moved = (q * x).colwise() + shift;
    const Positions expected = (q * p.apply(x)).colwise() + shift;
    EXPECT_LT((p.apply(moved) - expected).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Prolongation, IsBarycentricOnAFlatSheet) {
    Patch patch(50, true);
    const Prolongation p = patch.prolongation();
    EXPECT_LT(p.offsets().cwiseAbs().maxCoeff(), 1e-15);
    const Positions x = patch.deformed(0.3);
    const Prolongation intrinsic(patch.coarse_rest, patch.faces, patch.anchors, patch.fine_rest,
                                 ProlongationOperator::intrinsic);
    EXPECT_LT((p.apply(x) - intrinsic.apply(x)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Prolongation, JacobianMatchesCentralDifferences) {
    Patch patch(30);
    const Prolongation p = patch.prolongation();
    const Positions x = patch.deformed(0.2);
    const auto blocks = p.jacobian(x);
    const double h = 1e-6;
    double error = 0, size = 0;
    for (int v = 0; v < 9; ++v)
        for (int axis = 0; axis < 3; ++axis) {
            Positions plus = x, minus = x;
            plus(axis, v) += h;
            minus(axis, v) -= h;
            const Positions difference = (p.apply(plus) - p.apply(minus)) / (2 * h);
            for (int i = 0; i < 30; ++i) {
                Vec3 expected = Vec3::Zero();
                const Face& face =
                    patch.faces[static_cast<std::size_t>(patch.anchors[static_cast<std::size_t>(i)].face)];
                for (int k = 0; k < 3; ++k)
                    if (face[static_cast<std::size_t>(k)] == v)
                        expected = blocks[static_cast<std::size_t>(i)].col(3 * k + axis);
                error = std::max(error, (difference.col(i) - expected).norm());
                size = std::max(size, expected.norm());
            }
        }
    EXPECT_LT(error, 1e-6 * size);
}

TEST(Prolongation, PullBackIsTheTransposeOfTheJacobian) {
    Patch patch(40);
    const Prolongation p = patch.prolongation();
    const Positions x = patch.deformed(0.2);
    Positions g(3, 40);
    for (int i = 0; i < 40; ++i)
        g.col(i) = patch.noise(1);
    Positions expected = Positions::Zero(3, 9);
    const auto blocks = p.jacobian(x);
    for (std::size_t i = 0; i < 40; ++i) {
        const Face& face = patch.faces[static_cast<std::size_t>(patch.anchors[i].face)];
        const Eigen::Matrix<double, 9, 1> pulled = blocks[i].transpose() * g.col(static_cast<int>(i));
        for (int k = 0; k < 3; ++k)
            expected.col(face[static_cast<std::size_t>(k)]) += pulled.segment<3>(3 * k);
    }
    EXPECT_LT((p.pull_back(x, g) - expected).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((p.pull_back_lagged(g).rowwise().sum() - g.rowwise().sum()).norm(), 1e-13);
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

TEST(GalerkinProduct, EqualsTheDenseTripleProduct) {
    Patch patch(40);
    const Prolongation p = patch.prolongation();
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
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(120, 27);
    const auto blocks = p.jacobian(x);
    for (std::size_t i = 0; i < 40; ++i) {
        const Face& face = patch.faces[static_cast<std::size_t>(patch.anchors[i].face)];
        for (int k = 0; k < 3; ++k)
            jacobian.block<3, 3>(3 * static_cast<int>(i), 3 * face[static_cast<std::size_t>(k)]) =
                blocks[i].middleCols<3>(3 * k);
    }
    const Eigen::MatrixXd expected = jacobian.transpose() * fine * jacobian;

    std::vector<Edge> pairs;
    for (const auto& vertices : elements)
        for (int v : vertices)
            for (int w : vertices)
                if (v < w)
                    pairs.push_back({v, w});
    GalerkinProduct product(p, pairs);
    NewtonSystem fine_system(std::vector<std::uint8_t>(120, 0), product.fine_pairs());
    fine_system.begin({});
    for (std::size_t e = 0; e < elements.size(); ++e)
        fine_system.add(elements[e], hessians[e]);
    NewtonSystem system(std::vector<std::uint8_t>(27, 0), product.pairs());
    product.place_in(system);
    system.begin({});
    product.add(blocks, fine_system, system);
    const Eigen::MatrixXd actual = dense(system);
    EXPECT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.cwiseAbs().maxCoeff());
}

} // namespace
