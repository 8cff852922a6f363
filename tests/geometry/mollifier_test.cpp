#include <plisse/geometry/mollifier.h>

#include <gtest/gtest.h>

#include "geometry/stencils.h"

namespace plisse {
namespace {

TEST(Mollifier, CrossOfUnitCrossAndOfParallelEdges) {
    EXPECT_DOUBLE_EQ(cross_squared(stencil({-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0})), 16);
    EXPECT_EQ(cross_squared(stencil({-1, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {1, 1, 0})), 0);
    EXPECT_NEAR(cross_squared(stencil({-1, 0, 0}, {1, 0, 0}, {-1, 1, -1e-9}, {1, 1, 1e-9})), 0, 1e-16);
}

TEST(Mollifier, DerivativesOfTheCross) {
    Random random(2);
    for (int trial = 0; trial < 30; ++trial) {
        const Stencil x = random_stencil(random);
        const Vec12 gradient = difference_gradient(cross_squared, x, 1e-5);
        const Mat12 hessian = difference_hessian(cross_squared_gradient, x, 1e-5);
        EXPECT_LT((cross_squared_gradient(x) - gradient).norm(), 1e-7 * gradient.norm());
        EXPECT_LT((cross_squared_hessian(x) - hessian).norm(), 1e-6 * hessian.norm());
    }
}

TEST(Mollifier, RunsFromNothingToOneWithoutAKink) {
    constexpr double threshold = 0.3;
    EXPECT_EQ(mollify(0, threshold).value, 0);
    const double below = std::nextafter(threshold, 0);
    EXPECT_NEAR(mollify(below, threshold).value, 1, 1e-14);
    EXPECT_NEAR(mollify(below, threshold).first, 0, 1e-14);
    EXPECT_EQ(mollify(threshold, threshold).value, 1);
    EXPECT_EQ(mollify(threshold, threshold).first, 0);
    for (double c = 0.01; c < threshold; c += 0.02) {
        constexpr double h = 1e-6;
        const Mollifier low = mollify(c - h, threshold), high = mollify(c + h, threshold);
        EXPECT_NEAR(mollify(c, threshold).first, (high.value - low.value) / (2 * h), 1e-7);
        EXPECT_NEAR(mollify(c, threshold).second, (high.first - low.first) / (2 * h), 1e-6);
    }
    EXPECT_EQ(mollify(5, 0).value, 1); // point-triangle pairs have no threshold
}

} // namespace
} // namespace plisse
