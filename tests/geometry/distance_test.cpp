#include <plisse/geometry/distance.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <bit>
#include <cmath>
#include <map>

#include "geometry/stencils.h"

namespace plisse {
namespace {

using Separate = Separation (*)(const Stencil&);

Separation points_of(const Stencil& x) {
    return separate_points(x.col(0), x.col(1));
}
Separation point_edge_of(const Stencil& x) {
    return separate_point_edge(x.col(0), x.col(1), x.col(2));
}

/// Least distance over a fine grid of both closest points' places, refined around the best one.
double brute_force_squared_distance(const Stencil& x, bool edges) {
    const auto offset = [&](double s, double t) -> Vec3 {
        if (edges)
            return (1 - s) * x.col(0) + s * x.col(1) - (1 - t) * x.col(2) - t * x.col(3);
        return x.col(0) - (1 - s) * x.col(1) - s * ((1 - t) * x.col(2) + t * x.col(3));
    };
    double best_s = 0.5, best_t = 0.5, best = offset(best_s, best_t).squaredNorm();
    for (double width = 0.5; width > 1e-9; width *= 0.7) {
        const double center_s = best_s, center_t = best_t;
        for (int i = -10; i <= 10; ++i)
            for (int j = -10; j <= 10; ++j) {
                const double s = std::clamp(center_s + width * i / 10, 0.0, 1.0);
                const double t = std::clamp(center_t + width * j / 10, 0.0, 1.0);
                const double squared = offset(s, t).squaredNorm();
                if (squared < best) {
                    best = squared;
                    best_s = s;
                    best_t = t;
                }
            }
    }
    return best;
}

void expect_consistent(const Separation& s, const Stencil& x) {
    EXPECT_NEAR((x * s.weights - s.offset).norm(), 0, 1e-14 * x.norm());
    EXPECT_NEAR(s.weights.sum(), 0, 1e-14);
    EXPECT_NEAR((x * s.slides - s.tangents).norm(), 0, 1e-14 * x.norm());
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ((s.corners >> i) & 1, s.weights[i] != 0) << i;
    EXPECT_EQ(s.freedom, std::popcount(s.corners) - 2);
}

TEST(Distance, AgreesWithBruteForce) {
    Random random(1);
    for (const bool edges : {false, true}) {
        std::map<int, int> seen;
        for (int trial = 0; trial < 300; ++trial) {
            const Stencil x = random_stencil(random);
            const Separation s = edges ? separate_edges(x) : separate_point_triangle(x);
            expect_consistent(s, x);
            EXPECT_NEAR(std::sqrt(s.squared_distance), std::sqrt(brute_force_squared_distance(x, edges)), 1e-7);
            const double alone = edges ? squared_distance_edges(x) : squared_distance_point_triangle(x);
            EXPECT_NEAR(alone, s.squared_distance, 1e-14);
            ++seen[s.corners];
        }
        EXPECT_EQ(seen.size(), edges ? 9U : 7U); // every feature comes up
    }
}

TEST(Distance, PointTriangleFeatures) {
    const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
    const auto corners = [&](const Vec3& p) { return separate_point_triangle(stencil(p, a, b, c)).corners; };
    EXPECT_EQ(corners({.2, .3, 1}), 0b1111);
    EXPECT_EQ(corners({-1, -1, 1}), 0b0011);
    EXPECT_EQ(corners({2, -.5, 1}), 0b0101);
    EXPECT_EQ(corners({-.5, 2, 1}), 0b1001);
    EXPECT_EQ(corners({.5, -1, 1}), 0b0111);
    EXPECT_EQ(corners({1, 1, 1}), 0b1101);
    EXPECT_EQ(corners({-1, .5, 1}), 0b1011);
}

TEST(Distance, EdgeEdgeFeatures) {
    const auto corners = [&](const Vec3& b0, const Vec3& b1) {
        return separate_edges(stencil({-1, 0, 0}, {1, 0, 0}, b0, b1)).corners;
    };
    EXPECT_EQ(corners({0, -1, 1}, {0, 1, 1}), 0b1111);
    EXPECT_EQ(corners({-3, 1, 0}, {-2, 1, 0}), 0b1001);
    EXPECT_EQ(corners({2, 1, 0}, {3, 1, 0}), 0b0110);
    EXPECT_EQ(corners({3, 1, 0}, {2, 1, 0}), 0b1010);
    EXPECT_EQ(corners({-2, 1, 0}, {-3, 1, 0}), 0b0101);
    EXPECT_EQ(corners({2, -1, 0}, {2, 1, 0}), 0b1110);
    EXPECT_EQ(corners({-2, -1, 0}, {-2, 1, 0}), 0b1101);
    EXPECT_EQ(corners({0, 1, 0}, {0, 2, 0}), 0b0111);
    EXPECT_EQ(corners({0, 2, 0}, {0, 1, 0}), 0b1011);
}

TEST(Distance, ParallelAndDegenerateEdges) {
    const auto distance = [](const Vec3& b0, const Vec3& b1) {
        const Stencil x = stencil({0, 0, 0}, {2, 0, 0}, b0, b1);
        return std::sqrt(separate_edges(x).squared_distance);
    };
    EXPECT_DOUBLE_EQ(distance({1, .5, 0}, {3, .5, 0}), .5);  // overlapping
    EXPECT_DOUBLE_EQ(distance({-1, .5, 0}, {3, .5, 0}), .5); // one within the other
    EXPECT_DOUBLE_EQ(distance({3, .5, 0}, {1, .5, 0}), .5);  // turned round
    EXPECT_DOUBLE_EQ(distance({5, 4, 0}, {6, 4, 0}), 5);     // beyond each other
    EXPECT_DOUBLE_EQ(distance({3, 0, 0}, {4, 0, 0}), 1);     // collinear
    EXPECT_DOUBLE_EQ(distance({1, 0, 0}, {4, 0, 0}), 0);
    EXPECT_DOUBLE_EQ(distance({1, 2, 0}, {1, 2, 0}), 2);        // no length
    EXPECT_DOUBLE_EQ(distance({1, .5, 1e-13}, {3, .5, 0}), .5); // nearly parallel
}

TEST(Distance, DegenerateTriangles) {
    const auto distance = [](const Vec3& a, const Vec3& b, const Vec3& c) {
        return std::sqrt(separate_point_triangle(stencil({0, 1, 0}, a, b, c)).squared_distance);
    };
    EXPECT_DOUBLE_EQ(distance({-1, 0, 0}, {1, 0, 0}, {2, 0, 0}), 1);
    EXPECT_DOUBLE_EQ(distance({3, 5, 0}, {3, 5, 0}, {3, 5, 0}), 5);
    EXPECT_DOUBLE_EQ(distance({-1, 0, 0}, {1, 0, 0}, {1, 0, 0}), 1);
    EXPECT_NEAR(distance({-1, 0, 0}, {1, 0, 0}, {.3, 1e-14, 0}), 1, 1e-13);
}

TEST(Distance, TurnedEdgesKeepTheirDistance) {
    for (int k = -2; k <= 51; ++k)
        for (const double height : {1e-3, 1.0, 7.0}) {
            const Mat3 turn = Eigen::AngleAxisd(0.1 * k * M_PI + 0.3, Vec3::UnitY()).toRotationMatrix();
            const Mat3 half_turns = Eigen::AngleAxisd(k * M_PI, Vec3::UnitY()).toRotationMatrix();
            const Stencil x = stencil({-1, height, 0}, {1, height, 0}, turn * Vec3(-1, 0, 0), turn * Vec3(1, 0, 0));
            EXPECT_NEAR(separate_edges(x).squared_distance, height * height, 1e-12);
            const Stencil crossed =
                stencil(half_turns * Vec3(-1, height, 0), half_turns * Vec3(1, height, 0), {0, 0, -1}, {0, 0, 1});
            EXPECT_NEAR(separate_edges(crossed).squared_distance, height * height, 1e-12);
        }
}

TEST(Distance, FarFromTheOriginLosesNoDigitsBeyondThoseOfThePoints) {
    Stencil x = stencil({.25, 1, .25}, {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
    x.colwise() += Vec3(1048576, -1048576, 2097152); // exact sums
    EXPECT_EQ(separate_point_triangle(x).squared_distance, 1);
}

void expect_derivatives(Separate separate, const Stencil& x) {
    const Separation s = separate(x);
    const double feature_size = 1e-5 * std::sqrt(s.squared_distance);
    const auto squared = [&](const Stencil& y) { return separate(y).squared_distance; };
    const auto gradient = [&](const Stencil& y) { return squared_distance_gradient(separate(y)); };
    const Vec12 expected_gradient = difference_gradient(squared, x, feature_size);
    const Mat12 expected_hessian = difference_hessian(gradient, x, feature_size);
    EXPECT_LT((squared_distance_gradient(s) - expected_gradient).norm(), 1e-7 * expected_gradient.norm());
    EXPECT_LT((squared_distance_hessian(s) - expected_hessian).norm(), 1e-6 * expected_hessian.norm());
}

/// Far enough from a change of features for finite differences.
bool is_inside_its_feature(const Separation& s) {
    for (int i = 0; i < 4; ++i)
        if (s.weights[i] != 0 && std::abs(s.weights[i]) < 0.03)
            return false;
    return s.squared_distance > 0.01;
}

void expect_derivatives_everywhere(Separate separate, std::size_t feature_count) {
    Random random(5);
    std::map<int, int> seen;
    for (int trial = 0; trial < 400; ++trial) {
        const Stencil x = random_stencil(random);
        const Separation s = separate(x);
        if (!is_inside_its_feature(s) || (s.freedom == 2 && s.tangents.col(0).cross(s.tangents.col(1)).norm() < 0.1))
            continue;
        expect_derivatives(separate, x);
        ++seen[s.corners];
    }
    EXPECT_EQ(seen.size(), feature_count);
}

TEST(Distance, DerivativesOfPoints) {
    expect_derivatives_everywhere(points_of, 1);
}
TEST(Distance, DerivativesOfPointAndEdge) {
    expect_derivatives_everywhere(point_edge_of, 3);
}
TEST(Distance, DerivativesOfPointAndTriangle) {
    expect_derivatives_everywhere(separate_point_triangle, 7);
}
TEST(Distance, DerivativesOfEdges) {
    expect_derivatives_everywhere(separate_edges, 9);
}

TEST(Distance, ValueAndGradientAreContinuousAcrossFeatures) {
    Random random(8);
    int changes = 0;
    for (int trial = 0; trial < 200; ++trial)
        for (const Separate separate : {separate_point_triangle, separate_edges}) {
            const Stencil from = random_stencil(random), to = from + random_stencil(random, 0.3);
            double low = 0, high = 1;
            const auto at = [&](double t) { return separate(from + t * (to - from)); };
            if (at(0).corners == at(1).corners)
                continue;
            for (int halving = 0; halving < 45; ++halving) {
                const double middle = 0.5 * (low + high);
                (at(middle).corners == at(0).corners ? low : high) = middle;
            }
            const Separation before = at(low), after = at(high);
            EXPECT_NEAR(before.squared_distance, after.squared_distance, 1e-11);
            EXPECT_LT((squared_distance_gradient(before) - squared_distance_gradient(after)).norm(),
                      1e-6); // ties are decided by D, to half its digits
            ++changes;
        }
    EXPECT_GT(changes, 50);
}

TEST(Separation, MidpointIsHalfwayBetweenTheClosestPoints) {
    const Stencil edges = stencil({-1, 0.2, 0}, {1, 0.2, 0}, {0.5, 0, -1}, {0.5, 0, 2});
    EXPECT_LT((midpoint(separate_edges(edges), edges) - Vec3(0.5, 0.1, 0)).norm(), 1e-15);
    const Stencil point = stencil({3, 0.4, 0}, {0, 0, 0}, {2, 0, 0}, {0, 0, 2});
    EXPECT_LT((midpoint(separate_point_triangle(point), point) - Vec3(2.5, 0.2, 0)).norm(), 1e-15);
}

} // namespace
} // namespace plisse
