#include "geometry/known_motions.h"

#include "geometry/stencils.h"

namespace plisse {

namespace {

constexpr auto pt = StencilKind::point_triangle;
constexpr auto ee = StencilKind::edge_edge;
constexpr auto never = std::nullopt;

using List = std::vector<KnownMotion>;

Motion shifted(Motion m, double by) {
    m.from.array() += by;
    m.to.array() += by;
    return m;
}

void append_falling_points(List& list) {
    const Motion fixed = falling_point({0, 1, 0}, {0, -1, 0});
    list.push_back({"point on triangle", fixed, .5});
    Motion both = falling_point({0, 1, 0}, {0, 0, 0});
    both.to.rightCols<3>().row(1).array() += 1;
    list.push_back({"both move", both, .5});
    list.push_back({"point on corner", falling_point({0, 1, -1}, {0, -1, -1}), .5});
    list.push_back({"point on edge", falling_point({0, 1, 1}, {0, -1, 1}), .5});
    list.push_back({"just beside the edge", falling_point({0, 1, 1 + 1e-7}, {0, -1, 1 + 1e-7}), never});
    list.push_back({"just within the edge", falling_point({0, 1, 1 - 1e-7}, {0, -1, 1 - 1e-7}), .5});
    list.push_back({"slides in plane onto the edge", falling_point({0, 0, 3}, {0, 0, 0}), 2.0 / 3});
    list.push_back({"slides past in plane", falling_point({3, 0, 3}, {3, 0, -3}), never});
    list.push_back({"still, very near", falling_point({0, 1e-8, 0}, {0, 1e-8, 0}), never});
    list.push_back({"far from the origin", shifted(fixed, 1e6), .5, 1e-9});
    Motion line = fixed;
    line.from.rightCols<3>() << -1, 1, 2, 0, 0, 0, 0, 0, 0;
    line.to.rightCols<3>() = line.from.rightCols<3>();
    list.push_back({"triangle without area", line, .5});
    Motion dot = line;
    dot.from.rightCols<3>().setZero();
    dot.to.rightCols<3>().setZero();
    list.push_back({"triangle that is a point", dot, .5});
}

Motion crossing_edges(double x, double speed) {
    Motion m{ee, stencil({-1, -1, 0}, {1, -1, 0}, {x, 1, -1}, {x, 1, 1}), {}};
    m.to = m.from;
    m.to.leftCols<2>().row(1).array() += speed;
    m.to.rightCols<2>().row(1).array() -= speed;
    return m;
}

Motion falling_edge(const Vec3& b0, const Vec3& b1, const Vec3& by) {
    Motion m{ee, stencil({-1, 0, 0}, {1, 0, 0}, b0, b1), {}};
    m.to = m.from;
    m.to.rightCols<2>().colwise() += by;
    return m;
}

void append_edges(List& list) {
    list.push_back({"edges touch at the end", crossing_edges(0, 1), 1});
    list.push_back({"edges cross", crossing_edges(0, 2), .5});
    list.push_back({"edge on a corner", crossing_edges(1, 2), .5});
    list.push_back({"edge just past a corner", crossing_edges(1 + 1e-7, 2), never});
    const Vec3 down(0, -2, 0);
    list.push_back({"parallel edges", falling_edge({-.5, 1, 0}, {1.5, 1, 0}, down), .5});
    list.push_back({"parallel edges beside each other", falling_edge({1.1, 1, 0}, {3, 1, 0}, down), never});
    list.push_back({"collinear edges", falling_edge({2, 0, 0}, {3, 0, 0}, {-2, 0, 0}), .5});
    list.push_back({"edge without length", falling_edge({.2, 1, 0}, {.2, 1, 0}, down), .5});
    list.push_back({"coplanar sweep", falling_edge({0, 0, 1}, {0, 0, 2}, {0, 0, -3}), 1.0 / 3});
    list.push_back({"nearly parallel edges", falling_edge({-1, 1, -1e-9}, {1, 1, 1e-9}, down), .5});
}

void append_double_roots(List& list) {
    Motion one{ee,
               stencil({-3.0022200, 0.2362580, 0.0165247}, {-3.2347850, 0.8312380, -0.1151003},
                       {-3.0319900, 0.3148750, 0}, {-2.8548800, 0.0900349, 0}),
               {}};
    one.to = one.from;
    one.to.col(0) << -2.8995600, 0.0345838, 0.0638580;
    one.to.col(1) << -3.1716930, 0.6104858, -0.0713340;
    list.push_back({"double root 1", one, 0.13955201993126465});
    constexpr std::array<std::array<double, 2>, 5> times = {{{.5, .22540333075851662},
                                                             {.8, .14087708172407289},
                                                             {.88, .12807007429461172},
                                                             {.9, .12522407264362035},
                                                             {1, .11270166537925831}}};
    for (const auto& [speed, contact] : times) {
        Motion two{ee, stencil({0, 0, 1}, {0, 1, 1}, {.1, .2, 2}, {.1, .2, -1}),
                   stencil({1, 1, 0}, {0, 0, 0}, {.1, .2, 2}, {.1, .2, -1})};
        two.to = two.at(speed);
        list.push_back({"double root 2", two, contact});
    }
}

void append_slow_ones(List& list) {
    const double edge = -4.99999999958867e-07;
    Motion one{ee,
               stencil({1, 0.50803125, 2.10835646075301e-18}, {-2.38233935445388e-18, 0.50803125, 1}, {edge, .5, 0},
                       {edge, .5, 1}),
               {}};
    one.to = one.from;
    one.to.leftCols<2>().row(1).setConstant(0.47124375);
    list.push_back({"slow 1", one, never});
    Motion two{ee,
               stencil({1.00002232466453, 0.500004786049044, -2.06727783590977e-05},
                       {1.64687846177844e-05, 0.499996645067319, 1.63939999009028e-05}, {1, .5, 0}, {0, .5, 0}),
               {}};
    two.to = two.from;
    two.to.col(0) << 1.00294282700155, 0.498652627047143, 0.003626320742036;
    two.to.col(1) << -0.00219276550735626, 0.500871179186644, -0.00315828804921928;
    list.push_back({"slow 2", two, .0017989057379266321});
    for (const double gap : {1e-2, 1e-4, 1e-6, 1e-8}) {
        Motion m{ee, stencil({-1, -gap / 2, 0}, {1, -gap / 2, 0}, {0, gap / 2, -1}, {0, gap / 2, 1}), {}};
        m.to = m.from + stencil({-1e-3, gap, -1e-3}, {1e-3, gap, 1e-3}, {1e-3, -gap, 1e-3}, {-1e-3, -gap, -1e-3});
        list.push_back({"adversarial", m, .5, 1e-7});
    }
}

void append_published_point_triangles(List& list) {
    const Vec3 p(.1, .1, .1);
    list.push_back({"turning triangle",
                    {pt, stencil(p, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}), stencil(p, {0, 0, 0}, {0, 1, 0}, {1, 0, 0})},
                    .9});
    const Motion close = {pt,
                          stencil({0.0133653, 0.100651, -0.0215935}, {0.0100485, 0.0950896, -0.0171013},
                                  {0.0130388, 0.100666, -0.0218112}, {0.015413, 0.100554, -0.0202265}),
                          stencil({0.0133652999767858, 0.099670000268615, -0.0215934999996444},
                                  {0.0100484999799995, 0.0941086002577558, -0.0171012999972189},
                                  {0.0130387999724314, 0.0996850002629403, -0.0218111999936902},
                                  {0.0154129999740718, 0.0995730002646605, -0.020226499996014})};
    list.push_back({"close", close, never, 1e-7});
    const Motion beside = {pt, stencil({0, -1.19e-7, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}),
                           stencil({0, -1.19e-7, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1})};
    list.push_back({"beside", beside, never, 1e-7});
}

} // namespace

Motion falling_point(const Vec3& from, const Vec3& to) {
    const Vec3 a(-1, 0, 1), b(1, 0, 1), c(0, 0, -1);
    return {pt, stencil(from, a, b, c), stencil(to, a, b, c)};
}

const std::vector<KnownMotion>& known_motions() {
    static const List motions = [] {
        List list;
        append_falling_points(list);
        append_edges(list);
        append_double_roots(list);
        append_slow_ones(list);
        append_published_point_triangles(list);
        return list;
    }();
    return motions;
}

} // namespace plisse
