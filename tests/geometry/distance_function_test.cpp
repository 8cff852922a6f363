#include <plisse/geometry/distance_function.h>

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "geometry/stencils.h"

namespace plisse {
namespace {

/// Squared distances of two edges, and of two of their ends.
std::array<Separation, 3> separations_of(const Stencil& x) {
    return {separate_edges(x), separate_end(x, 0), separate_end(x, 3)};
}

/// f = sum_a c_a D_a + 1/2 sum_ab q_ab D_a D_b at the distances of x.
struct Quadratic {
    Vec3 c;
    Mat3 q;

    DistanceFunction at(const Stencil& x) const {
        const auto separations = separations_of(x);
        const Vec3 d(separations[0].squared_distance, separations[1].squared_distance, separations[2].squared_distance);
        DistanceFunction f(3);
        f.first = c + q * d;
        f.second = q;
        return f;
    }
    double value(const Stencil& x) const {
        const auto separations = separations_of(x);
        const Vec3 d(separations[0].squared_distance, separations[1].squared_distance, separations[2].squared_distance);
        return c.dot(d) + 0.5 * d.dot(q * d);
    }
};

Quadratic random_quadratic(Random& random) {
    Quadratic f;
    f.c = random_vector(random);
    f.q << random_vector(random), random_vector(random), random_vector(random);
    f.q = (f.q + f.q.transpose()).eval();
    return f;
}

/// Stencils away from the borders between features, where the derivatives jump.
bool is_clear(const Stencil& x) {
    for (const Separation& s : separations_of(x)) {
        if (s.squared_distance < 0.01)
            return false;
        for (int i = 0; i < 4; ++i)
            if (s.weights[i] != 0 && std::abs(s.weights[i]) < 0.02)
                return false;
        if (s.freedom == 2 && s.tangents.col(0).cross(s.tangents.col(1)).norm() <
                                  0.2 * s.tangents.col(0).norm() * s.tangents.col(1).norm())
            return false;
    }
    return true;
}

double least_eigenvalue(const Mat12& matrix) {
    return Eigen::SelfAdjointEigenSolver<Mat12>(matrix).eigenvalues()[0];
}

template <typename Check>
void for_random_functions(const Check& check) {
    Random random(5);
    for (int trials = 0; trials < 300;) {
        const Stencil x = random_stencil(random);
        const Quadratic f = random_quadratic(random);
        if (!is_clear(x))
            continue;
        ++trials;
        check(f, x);
    }
}

TEST(DistanceFunction, DerivativesAgreeWithDifferences) {
    for_random_functions([](const Quadratic& f, const Stencil& x) {
        const auto value_at = [&](const Stencil& y) { return f.value(y); };
        const auto gradient_at = [&](const Stencil& y) -> Vec12 { return gradient(f.at(y), separations_of(y)); };
        const Vec12 expected = difference_gradient(value_at, x, 1e-6);
        EXPECT_LT((gradient_at(x) - expected).norm(), 1e-7 * (1 + expected.norm()));
        const Mat12 expected_hessian = difference_hessian(gradient_at, x, 1e-6);
        EXPECT_LT((hessian(f.at(x), separations_of(x)) - expected_hessian).norm(),
                  1e-6 * (1 + expected_hessian.norm()));
    });
}

TEST(DistanceFunction, ProjectionIsSemiDefiniteAndNotBelowTheHessian) {
    for_random_functions([](const Quadratic& f, const Stencil& x) {
        const Mat12 exact = hessian(f.at(x), separations_of(x));
        const Mat12 projected = projected_hessian(f.at(x), separations_of(x));
        const double round_off = 1e-12 * (exact.norm() + projected.norm());
        EXPECT_GE(least_eigenvalue(projected), -round_off);
        EXPECT_GE(least_eigenvalue(projected - exact), -round_off);
        EXPECT_LT((projected - projected.transpose()).norm(), round_off);
    });
}

TEST(DistanceFunction, ProjectionOfOneDistanceBetweenCornersIsNearest) {
    Random random(6);
    for (const double slope : {-1.0, 0.5, 2.0})
        for (const double curvature : {-1.0, 0.0, 3.0}) {
            const Separation s = separate_points(random_vector(random), random_vector(random));
            DistanceFunction f(1);
            f.first << slope;
            f.second << curvature;
            const std::span<const Separation> separations(&s, 1);
            const Eigen::SelfAdjointEigenSolver<Mat12> eigen(hessian(f, separations));
            const Mat12 nearest =
                eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
            EXPECT_LT((projected_hessian(f, separations) - nearest).norm(), 1e-12 * (1 + nearest.norm()));
        }
}

} // namespace
} // namespace plisse
