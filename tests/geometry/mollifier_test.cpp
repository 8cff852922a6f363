#include <plisse/geometry/mollifier.h>

#include <gtest/gtest.h>

#include "geometry/stencils.h"

namespace plisse {
namespace {

double value_at(const Stencil& x, std::uint8_t ends = 0b1111) {
    const Separation s = separate_edges(x);
    return EdgeMollifier(s, x, ends).value();
}

/// Edges one above the other that cross at a share of the lower one.
Stencil crossing(double share, double height) {
    return stencil({-share, 0, 0}, {1 - share, 0, 0}, {0, height, -0.5}, {0, height, 0.5});
}

TEST(EdgeMollifier, IsOneWhereEdgesCrossFarFromTheirEndsAndNothingWhereAnEndIsNearest) {
    EXPECT_EQ(value_at(crossing(0.5, 0.1)), 1);
    EXPECT_EQ(value_at(crossing(0, 0.1)), 0);
    EXPECT_EQ(value_at(crossing(-0.2, 0.1)), 0);
    EXPECT_EQ(value_at(crossing(-0.2, 0.1), 0b1110), 1);                    // that end does not count
    const double ratio = 0.01 / (0.01 + 0.0025), q = (ratio - 0.25) / 0.75; // an end 0.05 beside the crossing
    EXPECT_NEAR(value_at(crossing(0.05, 0.1)), 1 - q * q * q, 1e-14);
}

TEST(EdgeMollifier, VanishesAsEdgesTurnParallel) {
    double last = 1;
    for (const double sine : {1e-1, 1e-2, 1e-4, 1e-8, 0.0}) {
        const double m = value_at(stencil({-1, 0, 0}, {1, 0, 0}, {-1, 0.2, -sine}, {1, 0.2, sine}));
        EXPECT_LE(m, std::min(last, 2e3 * std::pow(sine, 4)));
        last = m;
    }
    EXPECT_EQ(last, 0);
}

TEST(EdgeMollifier, HasNoKinkWhereAnEndBecomesTheNearestPointOrBeginsToCount) {
    constexpr double h = 1e-6;
    for (const double share : {0.0, std::sqrt(3) * 0.1}) {
        const double below = value_at(crossing(share - h, 0.1)), above = value_at(crossing(share + h, 0.1));
        EXPECT_NEAR(below, above, 1e-8);
    }
}

TEST(EdgeMollifier, DerivativesAgreeWithDifferences) {
    Random random(2);
    int ends_seen = 0, trials = 0;
    while (trials < 200) {
        const Stencil x = random_stencil(random);
        const Separation s = separate_edges(x);
        const EdgeMollifier m(s, x);
        if (s.freedom < 2 || m.value() == 1 || m.value() < 0.05 || s.squared_distance < 0.01)
            continue;
        ++trials;
        const auto gradient_at = [](const Stencil& y) {
            const EdgeMollifier there(separate_edges(y), y);
            return gradient(there.function(), there.separations());
        };
        const Vec12 expected_gradient = difference_gradient([](const Stencil& y) { return value_at(y); }, x, 1e-6);
        const Mat12 expected_hessian = difference_hessian(gradient_at, x, 1e-6);
        EXPECT_LT((gradient_at(x) - expected_gradient).norm(), 1e-7 * (1 + expected_gradient.norm()));
        EXPECT_LT((hessian(m.function(), m.separations()) - expected_hessian).norm(),
                  1e-6 * (1 + expected_hessian.norm()));
        for (int i = 0; i < 4; ++i)
            ends_seen |= squared_distance_end(x, i) < 4 * s.squared_distance ? 1 << i : 0;
    }
    EXPECT_EQ(ends_seen, 0b1111);
}

} // namespace
} // namespace plisse
