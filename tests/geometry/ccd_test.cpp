#include <plisse/geometry/ccd.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <optional>

#include "geometry/stencils.h"

namespace plisse {
namespace {

constexpr auto pt = StencilKind::point_triangle;
constexpr auto ee = StencilKind::edge_edge;
constexpr std::array<double, 3> ratios = {0.1, 0.9, 0.999};

double distance(StencilKind kind, const Stencil& x) {
    return std::sqrt(separate(kind, x).squared_distance);
}

/// Positions from one stencil to another.
struct Motion {
    Stencil from, to;
    Stencil by() const { return to - from; }
    Stencil at(double t) const { return from + t * by(); }
    Motion mapped(const Mat3& map, const Vec3& shift) const {
        return {(map * from).colwise() + shift, (map * to).colwise() + shift};
    }
};

/// The rules that every query obeys, given the exact time of first contact (none: never).
void expect_sound(StencilKind kind, const Motion& motion, std::optional<double> contact, double tolerance = 1e-12) {
    const double start = distance(kind, motion.from);
    ASSERT_GT(start, 0);
    for (const double ratio : ratios) {
        const double t = safe_step(kind, motion.from, motion.by(), ratio * start);
        EXPECT_GT(t, 0);
        if (contact) {
            EXPECT_LE(t, *contact);
        }
        EXPECT_GE(distance(kind, motion.at(t)), ratio * start * (1 - tolerance));
    }
    const double t = safe_step(kind, motion.from, motion.by(), 0);
    if (contact) {
        EXPECT_LE(t, *contact);
        EXPECT_LE(distance(kind, motion.at(t)), 2e-6 * start + 1e-14); // not stuck far before it either
    } else if (t < 1) { // a near miss, closer than the tolerance, may count as contact
        EXPECT_LE(distance(kind, motion.at(t)), 2e-6 * start);
    }
}

const Stencil resting_triangle = stencil({0, 1, 0}, {-1, 0, 1}, {1, 0, 1}, {0, 0, -1});

Motion falling_point(const Vec3& from, const Vec3& to) {
    Motion m{resting_triangle, resting_triangle};
    m.from.col(0) = from;
    m.to.col(0) = to;
    return m;
}

TEST(CcdTable, Row1PointFallsOnTriangle) {
    const Motion fixed = falling_point({0, 1, 0}, {0, -1, 0});
    expect_sound(pt, fixed, .5);
    Motion both = falling_point({0, 1, 0}, {0, 0, 0});
    both.to.rightCols<3>().row(1).array() += 1;
    expect_sound(pt, both, .5);
    for (const double ratio : ratios) // the exact time at which the distance has shrunk to the ratio
        EXPECT_NEAR(safe_step(pt, fixed.from, fixed.by(), ratio), (1 - ratio) / 2, 1e-6 * (1 - ratio));
}

TEST(CcdTable, Row2And3CornerAndEdge) {
    expect_sound(pt, falling_point({0, 1, -1}, {0, -1, -1}), .5);
    expect_sound(pt, falling_point({0, 1, 1}, {0, -1, 1}), .5);
    expect_sound(pt, falling_point({0, 1, 1 + 1e-7}, {0, -1, 1 + 1e-7}), std::nullopt);
    expect_sound(pt, falling_point({0, 1, 1 - 1e-7}, {0, -1, 1 - 1e-7}), .5);
}

TEST(CcdTable, Row4InPlane) {
    expect_sound(pt, falling_point({0, 0, 3}, {0, 0, 0}), 2.0 / 3);
    expect_sound(pt, falling_point({3, 0, 3}, {3, 0, -3}), std::nullopt);
}

TEST(CcdTable, Row5DegenerateTriangles) {
    Motion line = falling_point({0, 1, 0}, {0, -1, 0});
    line.from.rightCols<3>() << -1, 1, 2, 0, 0, 0, 0, 0, 0;
    line.to.rightCols<3>() = line.from.rightCols<3>();
    expect_sound(pt, line, .5);
    Motion dot = line;
    dot.from.rightCols<3>().setZero();
    dot.to.rightCols<3>().setZero();
    expect_sound(pt, dot, .5);
}

TEST(CcdTable, Row6TouchingAndStatic) {
    const Motion leaving = falling_point({0, 0, 0}, {0, 1, 0});
    EXPECT_EQ(safe_step(pt, leaving.from, leaving.by(), 0), 0); // a touching pair may not move
    expect_sound(pt, falling_point({0, 1e-8, 0}, {0, 1e-8, 0}), std::nullopt);
}

TEST(CcdTable, Row7FarFromTheOrigin) {
    expect_sound(pt, falling_point({0, 1, 0}, {0, -1, 0}).mapped(Mat3::Identity(), Vec3::Constant(1e6)), .5, 1e-9);
}

Motion crossing_edges(double x, double speed) {
    Motion m;
    m.from = stencil({-1, -1, 0}, {1, -1, 0}, {x, 1, -1}, {x, 1, 1});
    m.to = m.from;
    m.to.leftCols<2>().row(1).array() += speed;
    m.to.rightCols<2>().row(1).array() -= speed;
    return m;
}

TEST(CcdTable, Row8And9CrossingEdges) {
    expect_sound(ee, crossing_edges(0, 1), 1);
    expect_sound(ee, crossing_edges(0, 2), .5);
    expect_sound(ee, crossing_edges(1, 2), .5);
    expect_sound(ee, crossing_edges(1 + 1e-7, 2), std::nullopt);
}

Motion falling_edge(const Vec3& b0, const Vec3& b1, const Vec3& by) {
    Motion m;
    m.from = stencil({-1, 0, 0}, {1, 0, 0}, b0, b1);
    m.to = m.from;
    m.to.rightCols<2>().colwise() += by;
    return m;
}

TEST(CcdTable, Row10To12ParallelCollinearAndDegenerateEdges) {
    const Vec3 down(0, -2, 0);
    expect_sound(ee, falling_edge({-.5, 1, 0}, {1.5, 1, 0}, down), .5);
    expect_sound(ee, falling_edge({1.1, 1, 0}, {3, 1, 0}, down), std::nullopt);
    expect_sound(ee, falling_edge({2, 0, 0}, {3, 0, 0}, {-2, 0, 0}), .5);
    expect_sound(ee, falling_edge({.2, 1, 0}, {.2, 1, 0}, down), .5);
    expect_sound(ee, falling_edge({0, 0, 1}, {0, 0, 2}, {0, 0, -3}), 1.0 / 3);
    expect_sound(ee, falling_edge({-1, 1, -1e-9}, {1, 1, 1e-9}, down), .5);
}

// Rows 13 to 18: queries published with ipc-toolkit (tests/src/tests/ccd, commit b40e9c07).
TEST(CcdTable, Row13And14DoubleRoots) {
    Motion one;
    one.from = stencil({-3.0022200, 0.2362580, 0.0165247}, {-3.2347850, 0.8312380, -0.1151003},
                       {-3.0319900, 0.3148750, 0}, {-2.8548800, 0.0900349, 0});
    one.to = one.from;
    one.to.col(0) << -2.8995600, 0.0345838, 0.0638580;
    one.to.col(1) << -3.1716930, 0.6104858, -0.0713340;
    expect_sound(ee, one, 0.13955201993126465);
    constexpr std::array<std::array<double, 2>, 5> times = {{{.5, .22540333075851662},
                                                             {.8, .14087708172407289},
                                                             {.88, .12807007429461172},
                                                             {.9, .12522407264362035},
                                                             {1, .11270166537925831}}};
    for (const auto& [speed, contact] : times) {
        Motion two;
        two.from = stencil({0, 0, 1}, {0, 1, 1}, {.1, .2, 2}, {.1, .2, -1});
        two.to = stencil({1, 1, 0}, {0, 0, 0}, {.1, .2, 2}, {.1, .2, -1});
        two.to = two.at(speed);
        expect_sound(ee, two, contact);
    }
}

TEST(CcdTable, Row15And16Slow) {
    const double edge = -4.99999999958867e-07;
    Motion one;
    one.from = stencil({1, 0.50803125, 2.10835646075301e-18}, {-2.38233935445388e-18, 0.50803125, 1}, {edge, .5, 0},
                       {edge, .5, 1});
    one.to = one.from;
    one.to.leftCols<2>().row(1).setConstant(0.47124375);
    expect_sound(ee, one, std::nullopt);
    Motion two;
    two.from = stencil({1.00002232466453, 0.500004786049044, -2.06727783590977e-05},
                       {1.64687846177844e-05, 0.499996645067319, 1.63939999009028e-05}, {1, .5, 0}, {0, .5, 0});
    two.to = two.from;
    two.to.col(0) << 1.00294282700155, 0.498652627047143, 0.003626320742036;
    two.to.col(1) << -0.00219276550735626, 0.500871179186644, -0.00315828804921928;
    expect_sound(ee, two, .0017989057379266321);
}

TEST(CcdTable, Row17Adversarial) {
    for (const double gap : {1e-2, 1e-4, 1e-6, 1e-8}) {
        Motion m;
        m.from = stencil({-1, -gap / 2, 0}, {1, -gap / 2, 0}, {0, gap / 2, -1}, {0, gap / 2, 1});
        m.to = m.from + stencil({-1e-3, gap, -1e-3}, {1e-3, gap, 1e-3}, {1e-3, -gap, 1e-3}, {-1e-3, -gap, -1e-3});
        expect_sound(ee, m, .5, 1e-7);
    }
}

TEST(CcdTable, Row18PointTriangle) {
    const Vec3 p(.1, .1, .1);
    expect_sound(pt, {stencil(p, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}), stencil(p, {0, 0, 0}, {0, 1, 0}, {1, 0, 0})}, .9);
    const Motion close = {stencil({0.0133653, 0.100651, -0.0215935}, {0.0100485, 0.0950896, -0.0171013},
                                  {0.0130388, 0.100666, -0.0218112}, {0.015413, 0.100554, -0.0202265}),
                          stencil({0.0133652999767858, 0.099670000268615, -0.0215934999996444},
                                  {0.0100484999799995, 0.0941086002577558, -0.0171012999972189},
                                  {0.0130387999724314, 0.0996850002629403, -0.0218111999936902},
                                  {0.0154129999740718, 0.0995730002646605, -0.020226499996014})};
    expect_sound(pt, close, std::nullopt, 1e-7);
    for (const double y : {0.0, 1.19e-7}) {
        const Motion sliding = {stencil({0, y, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}),
                                stencil({0, y, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1})};
        EXPECT_EQ(safe_step(pt, sliding.from, sliding.by(), 0), 0);
    }
    const Motion beside = {stencil({0, -1.19e-7, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}),
                           stencil({0, -1.19e-7, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1})};
    expect_sound(pt, beside, std::nullopt, 1e-7);
}

TEST(Ccd, NeverOvershootsOnRandomMotions) {
    Random random(4);
    int stopped = 0, sure = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        const StencilKind kind = trial % 2 ? pt : ee;
        const double speed = std::pow(10.0, random.uniform(-2, 1));
        const Motion m = [&] {
            const Stencil from = random_stencil(random);
            return Motion{from, from + random_stencil(random, speed)};
        }();
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
        Motion m;
        m.from = stencil({.3, gap, .2}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0});
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
        const Motion m{from, from + random_stencil(random)};
        const double gap = 0.1 * distance(kind, m.from), t = safe_step(kind, m.from, m.by(), gap);
        for (const double scale : {std::ldexp(1.0, -40), std::ldexp(1.0, 30)})
            EXPECT_EQ(safe_step(kind, scale * m.from, scale * m.by(), scale * gap), t);
        const Mat3 turn =
            Eigen::AngleAxisd(random.uniform(0, 6), random_vector(random).normalized()).toRotationMatrix();
        const Motion turned = m.mapped(turn, Vec3::Zero());
        EXPECT_NEAR(safe_step(kind, turned.from, turned.by(), gap), t, 1e-6);
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
