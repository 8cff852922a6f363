#include <plisse/contact/pair_energy.h>

#include <gtest/gtest.h>

#include <map>

#include <Eigen/Eigenvalues>

#include <plisse/geometry/barrier.h>
#include <plisse/geometry/ccd.h>
#include <plisse/geometry/mollifier.h>

#include "geometry/stencils.h"

namespace plisse {
namespace {

/// A stencil, what it weighs, and which features it meets in.
struct Case {
    StencilKind kind;
    Stencil x;
    PairParameters parameters;
    Separation separation() const { return separate(kind, x); }
};

/// Whether an end that counts is the nearest point, where the mollifier is 0.
bool nearest_at_an_end(const Case& c, const Separation& s) {
    for (int i = 0; i < 4; ++i)
        if ((c.parameters.ends >> i & 1) != 0 && squared_distance_end(c.x, i) < 1.01 * s.squared_distance)
            return true;
    return false;
}

bool mollified(const Case& c) {
    return c.parameters.ends != 0 && EdgeMollifier(c.separation(), c.x, c.parameters.ends).separations().size() > 1;
}

/// Random pairs well inside their activation distance and their feature, those of edges with some of their ends
/// counted and some points counted off; every second pair has a least distance.
std::vector<Case> random_cases(int count) {
    Random random(3);
    std::vector<Case> cases;
    while (static_cast<int>(cases.size()) < count) {
        Case c;
        c.kind = random.below(2) ? StencilKind::point_triangle : StencilKind::edge_edge;
        c.x = random_stencil(random);
        const Separation s = c.separation();
        const double activation = std::sqrt(s.squared_distance) * random.uniform(1.05, 30);
        c.parameters = {random.uniform(0.5, 2), activation * activation};
        if (c.kind == StencilKind::edge_edge)
            c.parameters.ends = static_cast<std::uint8_t>(1 + random.below(15));
        else if (random.below(4) == 0)
            c.parameters.scale *= -1;
        if (random.below(2))
            c.parameters.least_squared = random.uniform(0, 0.25) * s.squared_distance;
        bool clear = s.squared_distance > 0.005;
        for (int i = 0; i < 4; ++i)
            clear = clear && (s.weights[i] == 0 || std::abs(s.weights[i]) > 0.05);
        if (s.freedom == 2)
            clear = clear && s.tangents.col(0).cross(s.tangents.col(1)).norm() >
                                 0.1 * s.tangents.col(0).norm() * s.tangents.col(1).norm();
        if (clear && !nearest_at_an_end(c, s))
            cases.push_back(c);
    }
    return cases;
}

Mat12 positive_part(const Mat12& matrix) {
    const Eigen::SelfAdjointEigenSolver<Mat12> eigen(matrix);
    return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

TEST(Barrier, ValueAndDerivatives) {
    EXPECT_EQ(barrier(1).value, 0);
    EXPECT_EQ(barrier(2).first, 0);
    EXPECT_NEAR(barrier(0.25).value, -0.5625 * std::log(0.25), 1e-15);
    EXPECT_TRUE(std::isinf(barrier(0).value));
    for (double x = 0.01; x < 1; x += 0.03) {
        constexpr double h = 1e-6;
        EXPECT_NEAR(barrier(x).first, (barrier(x + h).value - barrier(x - h).value) / (2 * h), 1e-7 * (1 + 1 / x));
        EXPECT_NEAR(barrier(x).second, (barrier(x + h).first - barrier(x - h).first) / (2 * h), 1e-6 / (x * x));
    }
}

/// VALIDATION.md, C1 (i): the slope of the barrier of squared distances by x, the gap over the contact distance, and
/// the gaps at which it bears a load.
TEST(Barrier, BearsTheLoadsOfTheTableAtItsGaps) {
    const auto slope = [](double x) { return 2 * x * std::abs(barrier(x * x).first); };
    EXPECT_NEAR(slope(0.1), 21.4256, 1e-4);
    EXPECT_NEAR(slope(0.5), 4.32944, 1e-5);
    EXPECT_NEAR(slope(0.9), 0.224355, 1e-6);
    const std::pair<double, double> gaps[] = {{1e-3, 0.993531}, {1e-2, 0.979447}, {0.1, 0.934003},
                                              {1, 0.780041},    {10, 0.239541},   {100, 0.020110}};
    for (const auto& [load, x] : gaps) {
        EXPECT_GT(slope(x - 1e-6), load);
        EXPECT_LT(slope(x + 1e-6), load);
    }
}

TEST(PairEnergy, DerivativesAgreeWithDifferences) {
    std::map<std::array<int, 3>, int> seen;
    for (const Case& c : random_cases(1500)) {
        const double gap = std::sqrt(c.separation().squared_distance) - std::sqrt(c.parameters.least_squared);
        const double step = 1.5e-6 * gap;
        const auto energy = [&](const Stencil& y) { return pair_energy(c.parameters, separate(c.kind, y), y); };
        const auto gradient = [&](const Stencil& y) { return pair_gradient(c.parameters, separate(c.kind, y), y); };
        const Vec12 expected_gradient = difference_gradient(energy, c.x, step);
        const Mat12 expected_hessian = difference_hessian(gradient, c.x, step);
        EXPECT_LT((gradient(c.x) - expected_gradient).norm(), 1e-7 * expected_gradient.norm());
        EXPECT_LT((pair_hessian(c.parameters, c.separation(), c.x) - expected_hessian).norm(),
                  1e-6 * expected_hessian.norm());
        ++seen[{static_cast<int>(c.kind), c.separation().freedom, mollified(c)}];
    }
    EXPECT_EQ(seen.size(), 9U); // each freedom for point-triangle, edges and mollified edges
}

double least_eigenvalue(const Mat12& matrix) {
    return Eigen::SelfAdjointEigenSolver<Mat12>(matrix).eigenvalues()[0];
}

TEST(PairEnergy, ProjectionIsSemiDefiniteAndNotFarAboveTheHessian) {
    double farthest = 0;
    for (const Case& c : random_cases(300)) {
        const Mat12 hessian = pair_hessian(c.parameters, c.separation(), c.x);
        const Mat12 projected = pair_projected_hessian(c.parameters, c.separation(), c.x);
        const double round_off = 1e-12 * hessian.norm();
        EXPECT_GE(least_eigenvalue(projected), -round_off);
        EXPECT_GE(least_eigenvalue(projected - hessian), -round_off);
        const Mat12 nearest = positive_part(hessian);
        if (!mollified(c) && c.separation().freedom == 0) {
            EXPECT_LT((projected - nearest).norm(), 10 * round_off);
        }
        farthest = std::max(farthest, projected.norm() / hessian.norm());
    }
    EXPECT_LT(farthest, 5);
}

TEST(PairEnergy, ProjectionIsNearestForNearPairsFacingEachOtherInTheMiddle) {
    for (const StencilKind kind : {StencilKind::point_triangle, StencilKind::edge_edge})
        for (const double d : {0.3, 0.1, 0.01}) {
            const Stencil x = kind == StencilKind::point_triangle
                                  ? stencil({0, d, 0}, {-1, 0, 1}, {1, 0, 1}, {0, 0, -2})
                                  : stencil({-1, d, 0}, {1, d, 0}, {0, 0, -1}, {0, 0, 1});
            const PairParameters p = {1, 0.16};
            const Mat12 nearest = positive_part(pair_hessian(p, separate(kind, x), x));
            EXPECT_LT((pair_projected_hessian(p, separate(kind, x), x) - nearest).norm(), 1e-12 * nearest.norm());
        }
}

TEST(PairEnergy, GaussNewtonPartIsTheSecondDerivativeAcross) {
    for (const Case& c : random_cases(100)) {
        const Separation s = c.separation();
        const double d = std::sqrt(s.squared_distance),
                     m = c.parameters.ends != 0 ? EdgeMollifier(s, c.x, c.parameters.ends).value() : 1;
        const auto slope = [&](double at) {
            const double least = c.parameters.least_squared, range = c.parameters.activation_squared - least;
            return 2 * at / range * barrier((at * at - least) / range).first;
        };
        const double second = (slope(d * 1.00001) - slope(d * 0.99999)) / (2e-5 * d);
        const Vec12 direction = squared_distance_gradient(s) / (2 * d);
        const Mat12 expected = std::max(0.0, m * c.parameters.scale * second) * direction * direction.transpose();
        EXPECT_LE((pair_gauss_newton_hessian(c.parameters, s, c.x) - expected).norm(), 1e-6 * expected.norm());
    }
}

} // namespace
} // namespace plisse
