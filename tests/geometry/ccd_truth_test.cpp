#include "geometry/ccd_truth.h"

#include <gtest/gtest.h>

#include "geometry/known_motions.h"
#include "geometry/reference_distance.h"
#include "geometry/stencils.h"

namespace plisse {
namespace {

constexpr auto pt = StencilKind::point_triangle;
constexpr auto ee = StencilKind::edge_edge;

Polynomial polynomial(std::vector<int> coefficients) {
    return Polynomial(std::vector<Integer>(coefficients.begin(), coefficients.end()));
}

TEST(ExactPolynomial, FindsEveryRootOnce) {
    const Polynomial third = polynomial({-1, 3}), half = polynomial({-1, 2}), zero = polynomial({0, 1});
    const Polynomial one = polynomial({-1, 1}), outside = polynomial({-5, 4}), complex = polynomial({1, -2, 4});
    const auto roots = [](const Polynomial& f) {
        std::vector<double> result;
        for (Root& root : roots_in_unit_interval(f))
            result.push_back(root.approximation());
        std::ranges::sort(result);
        return result;
    };
    using List = std::vector<double>;
    EXPECT_EQ(roots(third), List{1.0 / 3});
    EXPECT_EQ(roots(third * third * third), List{1.0 / 3});
    EXPECT_EQ(roots(third * half), (List{1.0 / 3, 0.5}));
    EXPECT_EQ(roots(half * half * zero * one), (List{0, 0.5, 1}));
    EXPECT_EQ(roots(zero * zero * one * third), (List{0, 1.0 / 3, 1}));
    EXPECT_EQ(roots(complex * outside), List{});
    EXPECT_EQ(roots(polynomial({7})), List{});
    const Polynomial close = polynomial({-333333, 1000000});
    EXPECT_EQ(roots(close * third), (List{0.333333, 1.0 / 3}));
    EXPECT_EQ(roots(polynomial({-1, 0, 2})), List{std::sqrt(0.5)});
}

TEST(ExactPolynomial, KnowsSignsAtIrrationalRoots) {
    Root root = roots_in_unit_interval(polynomial({-1, 0, 2}))[0]; // 2 t^2 = 1
    EXPECT_EQ(root.sign_of(polynomial({-1, 0, 2}) * polynomial({3, 1})), 0);
    EXPECT_EQ(root.sign_of(polynomial({1, 0, -4, 0, 4})), 0); // the square of the polynomial
    EXPECT_EQ(root.sign_of(polynomial({-70710678, 100000000})), 1);
    EXPECT_EQ(root.sign_of(polynomial({-70710679, 100000000})), -1);
    EXPECT_EQ(root.sign_of(Polynomial()), 0);
    EXPECT_EQ(root.compare(std::sqrt(0.5)), -1); // the double is a little more
    EXPECT_EQ(root.compare(std::nextafter(std::sqrt(0.5), 0)), 1);
    EXPECT_EQ(roots_in_unit_interval(polynomial({-3, 4}))[0].compare(0.75), 0);
}

/// Checks in every order of the corners, and shifted and scaled without rounding.
void expect_contact(StencilKind kind, const Stencil& x, const Stencil& d, std::optional<double> time) {
    Eigen::PermutationMatrix<4> turn, swap;
    turn.indices() = kind == pt ? Eigen::Vector4i(0, 2, 3, 1) : Eigen::Vector4i(2, 3, 1, 0);
    swap.indices() = kind == pt ? Eigen::Vector4i(0, 2, 1, 3) : Eigen::Vector4i(1, 0, 2, 3);
    Stencil from = x, by = d;
    for (int order = 0; order < 8; ++order) {
        for (const double scale : {1.0, 0x1p-300, 0x1p300}) {
            FirstContact contact(kind, scale * from, scale * by);
            ASSERT_EQ(contact.happens(), time.has_value());
            if (time) {
                EXPECT_NEAR(contact.approximation(), *time, 1e-15);
                EXPECT_TRUE(contact.by(std::min(1.0, *time + 1e-15)));
                EXPECT_TRUE(*time < 1e-15 || !contact.by(*time - 1e-15));
            }
        }
        const auto& permutation = order % 4 == 3 ? swap : turn;
        from = (from * permutation).eval();
        by = (by * permutation).eval();
    }
}

Stencil moves(const Vec3& a, const Vec3& b = Vec3::Zero(), const Vec3& c = Vec3::Zero(), const Vec3& d = Vec3::Zero()) {
    return stencil(a, b, c, d);
}

const Vec3 o(0, 0, 0), ex(1, 0, 0), ey(0, 1, 0), ez(0, 0, 1);

TEST(FirstContact, OfPointAndTriangle) {
    const auto falls = [](const Vec3& p, const Vec3& by) { return std::pair(stencil(p, o, ex, ey), moves(by)); };
    const auto expect = [&](const Vec3& p, const Vec3& by, std::optional<double> time) {
        const auto [x, d] = falls(p, by);
        expect_contact(pt, x, d, time);
    };
    expect({.25, .25, 1}, {0, 0, -2}, .5);
    expect({.25, .25, 1}, {0, 0, -1}, 1);                       // touches at the very end
    expect({.25, .25, 1}, {0, 0, -std::nextafter(1.0, 0)}, {}); // and all but touches
    expect({.5, .5, 1}, {0, 0, -3}, 1.0 / 3);                   // on the rim
    expect({.5, std::nextafter(.5, 1), 1}, {0, 0, -3}, {});     // just off it
    expect({0, 0, 1}, {0, 0, -1}, 1);                           // on a corner
    expect({-2, .25, 0}, {4, 0, 0}, .5);                        // within the plane
    expect({-2, 1, 0}, {4, 0, 0}, .5);                          // within the plane, onto a corner
    expect({-2, 1 + 1e-15, 0}, {4, 0, 0}, {});                  // within the plane, past it
    expect({2, -.75, 0}, {-3, 3, 0}, {});                       // within the plane, along the rim's outside
    expect({1.5, -.5, 0}, {-3, 3, 0}, 1.0 / 6);                 // within the plane, along the rim
    expect({.25, .25, 0}, {0, 0, 1}, 0);                        // leaves
    expect({.25, .25, 0}, {0, 0, 0}, 0);                        // rests on it
    expect({.25, .25, 1e-200}, {0, 0, 0}, {});                  // rests above it
    expect({2, 2, 1}, {0, 0, -2}, {});                          // passes the plane elsewhere
}

TEST(FirstContact, OfPointAndDegenerateTriangle) {
    const auto line = [](const Vec3& p) { return stencil(p, o, ex, 2 * ex); };
    expect_contact(pt, line({1.5, 0, 1}), moves({0, 0, -2}), .5);
    expect_contact(pt, line({1.5, 1, 1}), moves({0, -2, -2}), .5);
    expect_contact(pt, line({2.5, 0, 1}), moves({0, 0, -2}), {});
    expect_contact(pt, line({1.5, .25, 1}), moves({0, 0, -2}), {});
    expect_contact(pt, line({4, 0, 0}), moves({-3, 0, 0}), 2.0 / 3);
    expect_contact(pt, line({4, 0, 0}), moves({-1, 0, 0}), {});
    expect_contact(pt, stencil({0, 0, 1}, o, o, o), moves({0, 0, -4}), .25);
    expect_contact(pt, stencil({1e-200, 0, 1}, o, o, o), moves({0, 0, -4}), {});
    // It collapses onto the point at 1/2, to a line and to a point.
    expect_contact(pt, stencil({.75, 0, 0}, {0, -1, 0}, {1, -1, 0}, {0, 1, 0}),
                   moves(o, {0, 2, 0}, {0, 2, 0}, {0, -2, 0}), 0.5);
    expect_contact(pt, stencil({0, 0, 0}, ex, ey, ez), moves(o, -2 * ex, -2 * ey, -2 * ez), .5);
    expect_contact(pt, stencil({0, 0, -.5}, ex, ey, ez), moves(o, -ex, -ey, -ez), {});
}

TEST(FirstContact, OfEdges) {
    const auto expect = [](const Vec3& b0, const Vec3& b1, const Vec3& by, std::optional<double> time) {
        expect_contact(ee, stencil(o, ex, b0, b1), moves(o, o, by, by), time);
    };
    expect({.5, -1, 1}, {.5, 1, 1}, {0, 0, -4}, .25);
    expect({.5, -1, 1}, {.5, 1, 1}, {0, 0, -1}, 1);
    expect({1, -1, 1}, {1, 1, 1}, {0, 0, -4}, .25);                                          // over a corner
    expect({std::nextafter(1.0, 2), -1, 1}, {std::nextafter(1.0, 2), 1, 1}, {0, 0, -4}, {}); // past it
    expect({1, 0, 1}, {1, 1, 1}, {0, 0, -4}, .25);                                           // corner on corner
    expect({.25, 0, 1}, {2, 0, 1}, {0, 0, -3}, 1.0 / 3);                                     // parallel
    expect({1.25, 0, 1}, {2, 0, 1}, {0, 0, -3}, {});                                         // parallel, beside it
    expect({2, 0, 0}, {3, 0, 0}, {-3, 0, 0}, 1.0 / 3);                                       // along one line
    expect({2, 0, 0}, {3, 0, 0}, {-.5, 0, 0}, {});
    expect({3, 0, 0}, {2, 0, 0}, {-.5, 1e-200, 0}, {});
    expect({.5, 1, 0}, {.5, 2, 0}, {0, -3, 0}, 1.0 / 3); // within one plane
    expect({2, 1, 0}, {3, 2, 0}, {-1, -3, 0}, {});
    expect({.5, 0, 1}, {.5, 0, 1}, {0, 0, -2}, .5); // a point
    expect({.5, 1e-20, 1}, {.5, 1e-20, 1}, {0, 0, -2}, {});
    expect({.5, 0, 0}, {.75, 0, 0}, {0, 0, 1}, 0);                             // overlap and part
    expect_contact(ee, stencil(ex, ex, ey, ey), moves(-ex, -ex, -ey, -ey), 1); // two points
}

TEST(FirstContact, OfTurningEdges) {
    // One end of the second edge moves through the first, the other stays: f is linear in time.
    expect_contact(ee, stencil(o, ex, {.5, 1, 0}, {.5, 0, 1}), moves(o, o, o, {0, 0, -4}), .25);
    // Dips to the height h above the first edge and rises again: (2 t - 1)^2 + h.
    const auto dips = [](double h, std::optional<double> time) {
        expect_contact(ee, stencil({0, -1, -h}, {1, -1, -h}, {.5, -1, 1}, {.5, 1, -1}),
                       moves({0, 2, 0}, {0, 2, 0}, {0, 0, -2}, {0, 0, 2}), time);
    };
    dips(0, .5);
    dips(0x1p-100, {});
    dips(-0x1p-100, .5 - 0x1p-51);
    dips(-.25, .25);
}

TEST(FirstContact, AgreesWithKnownMotions) {
    for (const KnownMotion& known : known_motions()) {
        FirstContact contact(known.motion.kind, known.motion.from, known.motion.by());
        ASSERT_EQ(contact.happens(), known.contact.has_value()) << known.name;
        if (known.contact) {
            EXPECT_NEAR(contact.approximation(), *known.contact, 1e-12) << known.name;
        }
    }
}

TEST(ReferenceDistance, AgreesWithKnownDistances) {
    const auto point = [](const Vec3& p) { return reference_distance(pt, stencil(p, o, ex, ey)); };
    EXPECT_DOUBLE_EQ(point({.25, .25, -2}), 2);
    EXPECT_DOUBLE_EQ(point({1, 1, 0}), std::sqrt(.5));
    EXPECT_DOUBLE_EQ(point({-3, -4, 0}), 5);
    EXPECT_DOUBLE_EQ(point({.25, .25, 1e-200}), 1e-200);
    EXPECT_EQ(point({.25, .25, 0}), 0);
    const auto edges = [](const Vec3& a, const Vec3& b) { return reference_distance(ee, stencil(o, ex, a, b)); };
    EXPECT_DOUBLE_EQ(edges({.5, -1, 3}, {.5, 1, 3}), 3);
    EXPECT_DOUBLE_EQ(edges({.5, 0, 3}, {1.5, 0, 3}), 3);
    EXPECT_DOUBLE_EQ(edges({2, 0, 0}, {3, 0, 0}), 1);
    EXPECT_DOUBLE_EQ(edges({4, 4, 0}, {4, 4, 0}), 5);
    EXPECT_NEAR(edges({0, -1e-12, 1e-14}, {1, 1e-12, 1e-14}), 1e-14, 1e-18);
    EXPECT_EQ(edges({.5, -1, 0}, {.5, 1, 0}), 0);
}

TEST(SurelyKeepGap, ProvesWhatIsTrueAndNothingElse) {
    const Stencil x = stencil({.25, .25, 1}, o, ex, ey), d = moves({0, 0, -2});
    EXPECT_TRUE(surely_keep_gap(pt, x, d, 0, .5 - 1e-15));
    EXPECT_FALSE(surely_keep_gap(pt, x, d, 0, .5));
    EXPECT_FALSE(surely_keep_gap(pt, x, d, 0, 1));
    EXPECT_TRUE(surely_keep_gap(pt, x, d, .5, .25 - 1e-15));
    EXPECT_FALSE(surely_keep_gap(pt, x, d, .5, .25 + 1e-15));
    const auto dips = [](double height) { // as low as `height` at 1/2
        return std::pair(stencil({0, -1, -height}, {1, -1, -height}, {.5, -1, 1}, {.5, 1, -1}),
                         moves({0, 2, 0}, {0, 2, 0}, {0, 0, -2}, {0, 0, 2}));
    };
    const double height = 1e-3;
    const auto [from, by] = dips(height);
    EXPECT_TRUE(surely_keep_gap(ee, from, by, 0, 1));
    EXPECT_TRUE(surely_keep_gap(ee, from, by, height * (1 - 1e-3), 1));
    EXPECT_FALSE(surely_keep_gap(ee, from, by, height * (1 + 1e-12), 1));
}

} // namespace
} // namespace plisse
