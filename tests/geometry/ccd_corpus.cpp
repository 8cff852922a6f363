#include "geometry/ccd_corpus.h"

#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "geometry/known_motions.h"
#include "geometry/stencils.h"

namespace plisse {

namespace {

constexpr auto pt = StencilKind::point_triangle;

double power_of_ten(Random& random, double low, double high) {
    return std::pow(10.0, random.uniform(low, high));
}

double random_sign(Random& random) {
    return random.below(2) == 0 ? -1 : 1;
}

Vec3 random_direction(Random& random) {
    Vec3 v = random_vector(random);
    while (v.squaredNorm() < 0.01)
        v = random_vector(random);
    return v.normalized();
}

/// Weights of the corners at a place within both primitives: X w = 0 where they touch.
Vec4 place_inside(StencilKind kind, Random& random) {
    const double u = random.uniform(), v = random.uniform();
    if (kind == pt)
        return u + v < 1 ? Vec4(1, -(1 - u - v), -u, -v) : Vec4(1, -(u + v - 1), -(1 - u), -(1 - v));
    return {1 - u, u, -(1 - v), -v};
}

/// The same at an edge or a corner of the primitives.
Vec4 place_on_border(StencilKind kind, Random& random) {
    const double u = random.below(2) == 0 ? random.uniform() : random.below(2), v = random.below(2);
    if (kind != pt)
        return random.below(2) == 0 ? Vec4(1 - u, u, -(1 - v), -v) : Vec4(1 - v, v, -(1 - u), -u);
    Vec4 place(1, -(1 - u), -u, 0);
    std::swap(place[3], place[1 + random.below(3)]);
    return place;
}

/// Moves the first primitive so that the place on it comes to lie at `offset` from the one on the second.
void put_at(Stencil& x, StencilKind kind, const Vec4& place, const Vec3& offset) {
    x.leftCols(kind == pt ? 1 : 2).colwise() += Vec3(offset - x * place);
}

/// Square to both primitives.
Vec3 common_normal(StencilKind kind, const Stencil& x) {
    const Vec3 u = kind == pt ? x.col(2) - x.col(1) : x.col(1) - x.col(0);
    const Vec3 v = kind == pt ? x.col(3) - x.col(1) : x.col(3) - x.col(2);
    return u.cross(v).normalized();
}

/// A random motion that brings the places within `offset` of each other at `time`, but for rounding.
CcdQuery meeting(StencilKind kind, Random& random, const Vec4& place, const Vec3& offset, double time) {
    Stencil at_meeting = random_stencil(random);
    put_at(at_meeting, kind, place, offset);
    const Stencil d = random_stencil(random, power_of_ten(random, -2, 1));
    return {kind, at_meeting - time * d, d};
}

CcdQuery meeting_inside(StencilKind kind, Random& random) {
    return meeting(kind, random, place_inside(kind, random), Vec3::Zero(), random.uniform());
}

Vec3 small_offset(Random& random) {
    return random.below(4) == 0 ? Vec3::Zero() : Vec3(power_of_ten(random, -17, -2) * random_direction(random));
}

Stencil random_lattice(Random& random, int size) {
    Stencil x;
    for (int i = 0; i < 12; ++i)
        x(i) = random.below(2 * size + 1) - size;
    return x;
}

CcdQuery anywhere(StencilKind kind, Random& random) {
    const Stencil x = random_stencil(random);
    return {kind, x, random_stencil(random, power_of_ten(random, -2, 1))};
}

CcdQuery on_borders(StencilKind kind, Random& random) {
    const Vec4 place = place_on_border(kind, random);
    const Vec3 offset = small_offset(random);
    return meeting(kind, random, place, offset, random.uniform());
}

/// At the meeting place nothing moves along the common normal: the cubic in time has a root next to a double one.
CcdQuery grazing(StencilKind kind, Random& random) {
    const Vec4 place = place_inside(kind, random);
    Stencil at_meeting = random_stencil(random);
    put_at(at_meeting, kind, place, Vec3::Zero());
    const Vec3 normal = common_normal(kind, at_meeting);
    put_at(at_meeting, kind, place, random_sign(random) * power_of_ten(random, -17, -2) * normal);
    Stencil d = random_stencil(random, power_of_ten(random, -2, 1));
    d.leftCols(kind == pt ? 1 : 2).colwise() -= Vec3(normal.dot(d * place) * normal);
    return {kind, at_meeting - random.uniform() * d, d};
}

/// Touches at time 1, all but touches, or misses by a rounding.
CcdQuery at_the_end(StencilKind kind, Random& random) {
    const Stencil last = random_lattice(random, 4), first = random_lattice(random, 8);
    CcdQuery query{kind, first, last - first};
    const int i = random.below(12);
    if (random.below(2) == 0)
        query.d(i) = std::nextafter(query.d(i), random_sign(random) * 100);
    return query;
}

/// Parallel edges, or a point that flies along a plane, in any direction.
CcdQuery parallel(StencilKind kind, Random& random) {
    Stencil x = random_stencil(random);
    if (kind == pt)
        x.row(2).tail<3>().setZero();
    else
        x.col(3) = x.col(2) + random.uniform(-2, 2) * (x.col(1) - x.col(0));
    const Vec4 place = place_inside(kind, random);
    const double height = power_of_ten(random, -14, -1);
    put_at(x, kind, place, height * Vec3::UnitZ());
    Stencil d = Stencil::Zero();
    d.leftCols(kind == pt ? 1 : 2).colwise() += random_vector(random, power_of_ten(random, -2, 0));
    d.row(2) *= random.below(2) == 0 ? 0 : height;
    return {kind, x, d};
}

/// Edges at a small angle and near each other, or a point near a plane it flies along at a small angle.
CcdQuery nearly_parallel(StencilKind kind, Random& random) {
    CcdQuery query = parallel(kind, random);
    const double angle = power_of_ten(random, -16, -4);
    query.x += random_stencil(random, angle);
    query.d += random_stencil(random, power_of_ten(random, -16, 0));
    return query;
}

/// All within one tilted plane of the lattice, at all times.
CcdQuery coplanar(StencilKind kind, Random& random) {
    const int size = random.below(2) == 0 ? 3 : 1000;
    CcdQuery query{kind, random_lattice(random, size), random_lattice(random, size)};
    for (Stencil* s : {&query.x, &query.d})
        s->row(2) = s->row(0) - 2 * s->row(1);
    return query;
}

/// All within one line of the lattice, at the start or at all times.
CcdQuery collinear(StencilKind kind, Random& random) {
    const int size = random.below(2) == 0 ? 4 : 1000;
    CcdQuery query{kind, random_lattice(random, size), random_lattice(random, size)};
    const Vec3 line(random.below(5) - 2, random.below(5) - 2, 1);
    query.x = (line * query.x.row(0)).eval();
    if (random.below(3) > 0)
        query.d = (line * query.d.row(0)).eval();
    return query;
}

/// Triangles without area and edges without length that meet something or nearly do.
CcdQuery degenerate(StencilKind kind, Random& random) {
    Stencil at_meeting = random_stencil(random), d = random_stencil(random);
    const double share = random.below(4) == 0 ? 0 : random.uniform(-1, 2);
    for (Stencil* s : {&at_meeting, &d})
        s->col(3) = kind == pt ? Vec3((1 - share) * s->col(1) + share * s->col(2)) : Vec3(s->col(2));
    if (random.below(4) == 0)
        for (Stencil* s : {&at_meeting, &d})
            s->col(kind == pt ? 2 : 1) = s->col(kind == pt ? 1 : 0);
    const Vec4 place = random.below(2) == 0 ? place_inside(kind, random) : place_on_border(kind, random);
    put_at(at_meeting, kind, place, small_offset(random));
    return {kind, at_meeting - random.uniform() * d, d};
}

/// A triangle or an edge shrinks to a line or a point just where the two meet.
CcdQuery collapsing(StencilKind kind, Random& random) {
    const double time = std::ldexp(random.below(9), -3);
    CcdQuery query = meeting_inside(kind, random);
    const Vec3 target = random_lattice(random, 4).col(0);
    const int first = random.below(3) == 0 ? 0 : kind == pt ? 1 : 2;
    Stencil at_meeting = random_lattice(random, 4);
    for (int i = first; i < 4; ++i)
        at_meeting.col(i) = target;
    if (kind == pt && random.below(2) == 0)
        at_meeting.col(3) += random_lattice(random, 1).col(0);
    query.d = random_lattice(random, 4);
    query.x = at_meeting - time * query.d;
    if (random.below(2) == 0)
        query.x.col(random.below(4)) += small_offset(random);
    return query;
}

CcdQuery coarse_lattice(StencilKind kind, Random& random) {
    const Stencil x = random_lattice(random, 2);
    return {kind, x, random_lattice(random, 3)};
}

CcdQuery fine_lattice(StencilKind kind, Random& random) {
    const Stencil x = random_lattice(random, 40);
    return {kind, x, random_lattice(random, 60)};
}

CcdQuery scaled(CcdQuery query, double scale) {
    query.x *= scale;
    query.d *= scale;
    return query;
}

CcdQuery huge(StencilKind kind, Random& random) {
    const double scale = power_of_ten(random, 3, 150);
    return scaled(on_borders(kind, random), scale);
}

CcdQuery tiny(StencilKind kind, Random& random) {
    const double scale = power_of_ten(random, -150, -3);
    return scaled(on_borders(kind, random), scale);
}

/// One primitive, or one corner of it, of another size than the rest.
CcdQuery mixed_scales(StencilKind kind, Random& random) {
    Stencil at_meeting = random_stencil(random);
    at_meeting.leftCols(2) *= power_of_ten(random, -9, 3);
    at_meeting.col(3) *= power_of_ten(random, -3, 3);
    const Vec4 place = place_inside(kind, random);
    put_at(at_meeting, kind, place, small_offset(random));
    Stencil d = random_stencil(random);
    d.leftCols(2) *= power_of_ten(random, -9, 3);
    return {kind, at_meeting - random.uniform() * d, d};
}

CcdQuery far_from_the_origin(StencilKind kind, Random& random) {
    CcdQuery query = random.below(2) == 0 ? meeting_inside(kind, random) : on_borders(kind, random);
    query.x.colwise() += random_vector(random, power_of_ten(random, 2, 9));
    return query;
}

CcdQuery carried_along(StencilKind kind, Random& random) {
    CcdQuery query = random.below(2) == 0 ? meeting_inside(kind, random) : on_borders(kind, random);
    query.d.colwise() += random_vector(random, power_of_ten(random, 2, 9));
    return query;
}

CcdQuery very_near(StencilKind kind, Random& random) {
    Stencil x = random_stencil(random);
    const Vec4 place = random.below(2) == 0 ? place_inside(kind, random) : place_on_border(kind, random);
    put_at(x, kind, place, Vec3::Zero());
    put_at(x, kind, place, power_of_ten(random, -16, -4) * common_normal(kind, x));
    return {kind, x, random_stencil(random, power_of_ten(random, -12, 0))};
}

/// Slivers: triangles with a small height, a short edge, or both; short edges.
CcdQuery thin(StencilKind kind, Random& random) {
    Stencil at_meeting = random_stencil(random);
    at_meeting.col(3) = at_meeting.col(2) + power_of_ten(random, -12, -1) * random_vector(random);
    if (kind == pt && random.below(2) == 0)
        at_meeting.col(3) += random.uniform() * (at_meeting.col(1) - at_meeting.col(2));
    const Vec4 place = random.below(2) == 0 ? place_inside(kind, random) : place_on_border(kind, random);
    put_at(at_meeting, kind, place, small_offset(random));
    Stencil d = random_stencil(random);
    if (random.below(2) == 0)
        d.rightCols<3>().colwise() = Vec3(d.col(3));
    return {kind, at_meeting - random.uniform() * d, d};
}

/// Each corner goes through a point near the origin to about the opposite place.
CcdQuery inside_out(StencilKind kind, Random& random) {
    const Stencil x = random_stencil(random);
    return {kind, x, -2 * x + random_stencil(random, power_of_ten(random, -9, 0))};
}

CcdQuery starts_touching(StencilKind kind, Random& random) {
    Stencil x = random_lattice(random, 4), d = random_lattice(random, 4);
    const Vec4 place = kind == pt ? Vec4(1, -.25, -.25, -.5) : Vec4(.25, .75, -.5, -.5);
    put_at(x, kind, place, Vec3::Zero());
    return {kind, x, d};
}

/// No relative motion, near each other or not.
CcdQuery still(StencilKind kind, Random& random) {
    CcdQuery query = random.below(2) == 0 ? very_near(kind, random) : anywhere(kind, random);
    query.d.colwise() = random_vector(random, power_of_ten(random, -3, 3));
    return query;
}

/// Pieces of two layers of cloth with cells of a centimetre, a fraction of a millimetre apart.
CcdQuery cloth(StencilKind kind, Random& random) {
    Stencil x = random_stencil(random, 0.01);
    x.row(1) *= power_of_ten(random, -3, -1);
    const Vec4 place = random.below(2) == 0 ? place_inside(kind, random) : place_on_border(kind, random);
    put_at(x, kind, place, random_sign(random) * power_of_ten(random, -6, -3) * Vec3::UnitY());
    Stencil d = random_stencil(random, power_of_ten(random, -6, -2));
    d.colwise() += random_vector(random, power_of_ten(random, -5, -1));
    d.leftCols(kind == pt ? 1 : 2).colwise() += random_vector(random, power_of_ten(random, -6, -2));
    return {kind, x, d};
}

/// The hand-made motions, mirrored, turned about the axes and scaled by powers of two, all without rounding, then
/// moved by a few roundings.
CcdQuery known(StencilKind kind, Random& random) {
    const auto& all = known_motions();
    const Motion* motion = nullptr;
    while (!motion || motion->kind != kind)
        motion = &all[static_cast<std::size_t>(random.below(static_cast<int>(all.size())))].motion;
    Eigen::PermutationMatrix<3> turn;
    const int first = random.below(3), second = (first + 1 + random.below(2)) % 3;
    turn.indices() = Eigen::Vector3i(first, second, 3 - first - second);
    const double scale = std::ldexp(random_sign(random), random.below(41) - 20);
    CcdQuery query{kind, scale * (turn * motion->from), scale * (turn * motion->by())};
    if (random.below(2) == 0) {
        double& number = query.x(random.below(12));
        number = std::nextafter(number, random_sign(random) * 1e9);
    }
    return query;
}

constexpr std::array families = {CcdFamily{"anywhere", anywhere},
                                 CcdFamily{"meeting inside", meeting_inside},
                                 CcdFamily{"on borders", on_borders},
                                 CcdFamily{"grazing", grazing},
                                 CcdFamily{"at the end", at_the_end},
                                 CcdFamily{"parallel", parallel},
                                 CcdFamily{"nearly parallel", nearly_parallel},
                                 CcdFamily{"coplanar", coplanar},
                                 CcdFamily{"collinear", collinear},
                                 CcdFamily{"degenerate", degenerate},
                                 CcdFamily{"collapsing", collapsing},
                                 CcdFamily{"coarse lattice", coarse_lattice},
                                 CcdFamily{"fine lattice", fine_lattice},
                                 CcdFamily{"huge", huge},
                                 CcdFamily{"tiny", tiny},
                                 CcdFamily{"mixed scales", mixed_scales},
                                 CcdFamily{"far from the origin", far_from_the_origin},
                                 CcdFamily{"carried along", carried_along},
                                 CcdFamily{"very near", very_near},
                                 CcdFamily{"thin", thin},
                                 CcdFamily{"inside out", inside_out},
                                 CcdFamily{"starts touching", starts_touching},
                                 CcdFamily{"still", still},
                                 CcdFamily{"cloth", cloth},
                                 CcdFamily{"known", known}};

} // namespace

std::span<const CcdFamily> ccd_families() {
    return families;
}

CcdQuery ccd_query(const CcdFamily& family, int index) {
    std::uint64_t seed = static_cast<std::uint64_t>(index);
    for (const char* c = family.name; *c != 0; ++c)
        seed = Random(seed + static_cast<unsigned char>(*c)).bits();
    Random random(seed);
    return family.make(index % 2 == 0 ? pt : StencilKind::edge_edge, random);
}

std::string to_text(const CcdQuery& query) {
    std::string text = query.kind == pt ? "point-triangle" : "edge-edge";
    for (const auto& [name, s] : {std::pair("x", &query.x), std::pair("d", &query.d)}) {
        text += fmt::format("\n  {} =", name);
        for (int i = 0; i < 4; ++i)
            text += fmt::format(" ({:a}, {:a}, {:a})", (*s)(0, i), (*s)(1, i), (*s)(2, i));
    }
    return text;
}

} // namespace plisse
