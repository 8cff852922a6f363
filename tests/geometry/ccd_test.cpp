#include <plisse/geometry/ccd.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cctype>
#include <cmath>

#include "geometry/known_motions.h"
#include "geometry/stencils.h"

namespace plisse {
namespace {

constexpr auto pt = StencilKind::point_triangle;
constexpr auto ee = StencilKind::edge_edge;
constexpr std::array<double, 3> ratios = {0.1, 0.9, 0.999};

double distance(StencilKind kind, const Stencil& x) {
    return std::sqrt(separate(kind, x).squared_distance);
}

Motion turned(const Motion& m, const Mat3& by) {
    return {m.kind, by * m.from, by * m.to};
}

double step(const Motion& m, double gap) {
    return safe_step(m.kind, m.from, m.by(), gap);
}

class KnownMotions : public testing::TestWithParam<KnownMotion> {};

TEST_P(KnownMotions, AreStoppedBeforeContactAndNotLongBefore) {
    const auto& [name, motion, contact, tolerance] = GetParam();
    const double start = distance(motion.kind, motion.from);
    ASSERT_GT(start, 0);
    for (const double ratio : ratios) {
        const double t = step(motion, ratio * start);
        EXPECT_GT(t, 0);
        if (contact) {
            EXPECT_LE(t, *contact);
        }
        EXPECT_GE(distance(motion.kind, motion.at(t)), ratio * start * (1 - tolerance));
    }
    const double t = step(motion, 0);
    if (contact) {
        EXPECT_LE(t, *contact);
        EXPECT_LE(distance(motion.kind, motion.at(t)), 2e-6 * start + 1e-14); // not stuck far before it either
    } else if (t < 1) { // a near miss, closer than the tolerance, may count as contact
        EXPECT_LE(distance(motion.kind, motion.at(t)), 2e-6 * start);
    }
}

INSTANTIATE_TEST_SUITE_P(Ccd, KnownMotions, testing::ValuesIn(known_motions()), [](const auto& test) {
    std::string name = test.param.name + " " + std::to_string(test.index);
    std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
    return name;
});

TEST(Ccd, StopsWhereTheDistanceHasShrunkToTheRatio) {
    for (const double ratio : ratios)
        EXPECT_NEAR(step(falling_point({0, 1, 0}, {0, -1, 0}), ratio), (1 - ratio) / 2, 1e-6 * (1 - ratio));
}

TEST(Ccd, ATouchingPairMayNotMove) {
    EXPECT_EQ(step(falling_point({0, 0, 0}, {0, 1, 0}), 0), 0);
    for (const double y : {0.0, 1.19e-7}) {
        const Motion sliding = {pt, stencil({0, y, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}),
                                stencil({0, y, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1})};
        EXPECT_EQ(step(sliding, 0), 0);
    }
}

TEST(Ccd, NeverOvershootsOnRandomMotions) {
    Random random(4);
    int stopped = 0, sure = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const StencilKind kind = trial % 2 ? pt : ee;
        const double speed = std::pow(10.0, random.uniform(-2, 1));
        const Stencil from = random_stencil(random);
        const Motion m{kind, from, from + random_stencil(random, speed)};
        const double start = distance(kind, m.from);
        for (const double ratio : ratios) {
            const double t = safe_step(kind, m.from, m.by(), ratio * start);
            ASSERT_GT(t, 0);
            stopped += t < 1;
            ASSERT_FALSE(t < 1 && keeps_apart(kind, m.from, m.by(), start, ratio * start));
            sure += keeps_apart(kind, m.from, m.by(), start, ratio * start);
            for (int k = 0; k <= 200; ++k)
                ASSERT_GE(distance(kind, m.at(t * k / 200)), ratio * start * (1 - 1e-12));
            if (t < 1 && ratio < 0.99) { // and stops only where the distance has gone
                ASSERT_LE(distance(kind, m.at(t)), start * (ratio + 2e-6 * (1 - ratio)) + 1e-13);
            }
        }
    }
    EXPECT_GT(stopped, 2000);
    EXPECT_GT(sure, 500);
}

TEST(Ccd, StartingVeryNear) {
    Random random(6);
    for (int trial = 0; trial < 500; ++trial) {
        const double gap = std::pow(10.0, random.uniform(-12, -3));
        Motion m{pt, stencil({.3, gap, .2}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}), {}};
        m.to = m.from + random_stencil(random, 0.1);
        const double start = distance(pt, m.from), t = safe_step(pt, m.from, m.by(), 0.1 * start);
        ASSERT_GT(t, 0);
        for (int k = 0; k <= 200; ++k)
            ASSERT_GE(distance(pt, m.at(t * k / 200)), 0.1 * start);
    }
}

TEST(Ccd, IndependentOfScaleOrderAndFrame) {
    Random random(9);
    for (int trial = 0; trial < 500; ++trial) {
        const StencilKind kind = trial % 2 ? pt : ee;
        const Stencil from = random_stencil(random);
        const Motion m{kind, from, from + random_stencil(random)};
        const double gap = 0.1 * distance(kind, m.from), t = safe_step(kind, m.from, m.by(), gap);
        for (const double scale : {std::ldexp(1.0, -40), std::ldexp(1.0, 30)})
            EXPECT_EQ(safe_step(kind, scale * m.from, scale * m.by(), scale * gap), t);
        const Mat3 turn =
            Eigen::AngleAxisd(random.uniform(0, 6), random_vector(random).normalized()).toRotationMatrix();
        EXPECT_NEAR(step(turned(m, turn), gap), t, 1e-6);
        Eigen::PermutationMatrix<4> order;
        order.indices() = kind == pt ? Eigen::Vector4i(0, 2, 3, 1) : Eigen::Vector4i(2, 3, 1, 0);
        EXPECT_NEAR(safe_step(kind, m.from * order, m.by() * order, gap), t, 1e-6);
    }
}

TEST(Ccd, SharedMotionAndSlidingCostNothing) {
    Motion m = falling_point({0, 1e-3, 0}, {0, 1e-3, 0});
    m.to.colwise() += Vec3(100, -200, 300);
    EXPECT_EQ(safe_step(pt, m.from, m.by(), 0.9e-3), 1);
    m.to.col(0) += Vec3(50, 0, 50);
    EXPECT_EQ(safe_step(pt, m.from, m.by(), 0.9e-3), 1);
}

TEST(Ccd, EndsAtTheGivenTime) {
    const Motion m = falling_point({0, 1, 0}, {0, -1, 0});
    EXPECT_EQ(safe_step(pt, m.from, m.by(), 0.1, 0.25), 0.25);
}

} // namespace
} // namespace plisse
