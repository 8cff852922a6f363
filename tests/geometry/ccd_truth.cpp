#include "geometry/ccd_truth.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <CGAL/Interval_nt.h>

#include "geometry/reference_distance.h"

namespace plisse {

namespace {

struct Vector {
    Polynomial x, y, z;

    bool is_zero() const { return x.is_zero() && y.is_zero() && z.is_zero(); }
    Vector operator+(const Vector& o) const { return {x + o.x, y + o.y, z + o.z}; }
    Vector operator-(const Vector& o) const { return {x - o.x, y - o.y, z - o.z}; }
    Polynomial dot(const Vector& o) const { return x * o.x + y * o.y + z * o.z; }
    Vector cross(const Vector& o) const { return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x}; }
};

using Corners = std::array<Vector, 4>;

/// A finite double is mantissa * 2^exponent with an odd mantissa, or zero.
struct Parts {
    std::int64_t mantissa = 0;
    int exponent = 0;
};

Parts parts_of(double value) {
    if (value == 0)
        return {0, std::numeric_limits<int>::max()};
    int exponent = 0;
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &exponent), 53));
    const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
    return {mantissa >> zeros, exponent - 53 + zeros};
}

/// All corners as linear functions of time, in a unit of length in which all coordinates are whole.
Corners corners_of(const Stencil& x, const Stencil& d) {
    int unit = std::numeric_limits<int>::max();
    for (int i = 0; i < 12; ++i)
        unit = std::min({unit, parts_of(x(i)).exponent, parts_of(d(i)).exponent});
    const auto whole = [&](double value) {
        const Parts parts = parts_of(value);
        return parts.mantissa == 0 ? Integer(0) : Integer(parts.mantissa) << (parts.exponent - unit);
    };
    const auto coordinate = [&](int axis, int i) { return Polynomial({whole(x(axis, i)), whole(d(axis, i))}); };
    Corners corners;
    for (int i = 0; i < 4; ++i)
        corners[static_cast<std::size_t>(i)] = {coordinate(0, i), coordinate(1, i), coordinate(2, i)};
    return corners;
}

Polynomial volume(const Corners& c) {
    return (c[1] - c[0]).dot((c[2] - c[0]).cross(c[3] - c[0]));
}

/// A point lies on the segment when `across` is zero and `within` not positive; a segment may be a point.
struct PointOnSegment {
    Vector across;
    Polynomial within;

    PointOnSegment(const Vector& p, const Vector& a, const Vector& b)
        : across((p - a).cross(b - a)), within((p - a).dot(p - b)) {}
};

/// How coplanar primitives touch: while the normal is not zero, when nothing in `inside` is negative; otherwise all
/// primitives are segments or points, and a corner of one must lie on the other.
struct TouchConditions {
    Vector normal;
    std::vector<Polynomial> inside;
    std::vector<PointOnSegment> on_segments;

    TouchConditions(StencilKind kind, const Corners& c) {
        if (kind == StencilKind::point_triangle) {
            const auto& [p, t0, t1, t2] = c;
            normal = (t1 - t0).cross(t2 - t0);
            for (const auto& [a, b] : {std::pair(&t0, &t1), std::pair(&t1, &t2), std::pair(&t2, &t0)}) {
                inside.push_back(normal.dot((*b - *a).cross(p - *a)));
                on_segments.emplace_back(p, *a, *b);
            }
        } else {
            const auto& [a0, a1, b0, b1] = c;
            normal = (a1 - a0).cross(b1 - b0);
            // Places on the edges where their lines meet, 0 to normal.normal.
            const Polynomial scale = normal.dot(normal);
            for (const Vector& along : {b1 - b0, a1 - a0}) {
                inside.push_back(normal.dot((b0 - a0).cross(along)));
                inside.push_back(scale - inside.back());
            }
            on_segments = {{a0, b0, b1}, {a1, b0, b1}, {b0, a0, a1}, {b1, a0, a1}};
        }
    }

    bool hold_at(Root& root) const {
        const auto vanishes = [&](const Vector& v) {
            return root.sign_of(v.x) == 0 && root.sign_of(v.y) == 0 && root.sign_of(v.z) == 0;
        };
        if (!vanishes(normal))
            return std::all_of(inside.begin(), inside.end(), [&](const auto& f) { return root.sign_of(f) >= 0; });
        return std::any_of(on_segments.begin(), on_segments.end(),
                           [&](const PointOnSegment& s) { return vanishes(s.across) && root.sign_of(s.within) <= 0; });
    }

    /// All moments at which the answer of hold_at may change.
    std::vector<Root> changes() const {
        std::vector<Root> result;
        const auto append = [&](const Polynomial& f) {
            if (!f.is_zero())
                std::ranges::copy(roots_in_unit_interval(f), std::back_inserter(result));
        };
        const auto append_all = [&](const Vector& v) {
            append(v.x);
            append(v.y);
            append(v.z);
        };
        append_all(normal);
        for (const Polynomial& f : inside)
            append(f);
        for (const PointOnSegment& s : on_segments) {
            append_all(s.across);
            append(s.within);
        }
        return result;
    }
};

} // namespace

FirstContact::FirstContact(StencilKind kind, const Stencil& x, const Stencil& d) {
    const Corners corners = corners_of(x, d);
    const Polynomial f = volume(corners);
    if (!f.is_zero())
        times_ = roots_in_unit_interval(f);
    if (!f.is_zero() && times_.empty())
        return;
    const TouchConditions conditions(kind, corners);
    if (f.is_zero()) {
        times_ = conditions.changes();
        times_.emplace_back(0, 0);
    }
    std::erase_if(times_, [&](Root& root) { return !conditions.hold_at(root); });
}

bool FirstContact::by(double t) {
    return std::ranges::any_of(times_, [&](Root& root) { return root.compare(t) <= 0; });
}

double FirstContact::approximation() {
    double first = 1;
    for (Root& root : times_)
        first = std::min(first, root.approximation());
    return first;
}

namespace {

using Interval = CGAL::Interval_nt<false>;

/// The polygon of differences as it moves.
class MovingDifferences {
public:
    MovingDifferences(StencilKind kind, const Stencil& x, const Stencil& d)
        : corners_(difference_corners(kind)), x_(x), d_(d) {}

    Direction furthest_direction_at(double t) const {
        std::vector<LongVec3> points;
        for (const auto& [i, j] : corners_)
            points.emplace_back(difference(x_, i, j) + t * difference(d_, i, j));
        return furthest_direction(points);
    }

    /// Whether all corners are further than `gap` along n at time t. Takes rounding upwards for granted.
    bool surely_beyond(double gap, const Vec3& n, double t) const {
        Interval squared_length = 0;
        for (int axis = 0; axis < 3; ++axis)
            squared_length += Interval(n[axis]) * Interval(n[axis]);
        const Interval least = Interval(gap) * CGAL::sqrt(squared_length);
        return std::ranges::all_of(corners_, [&](const auto& corner) {
            const auto [i, j] = corner;
            Interval height = 0;
            for (int axis = 0; axis < 3; ++axis) {
                const Interval start = Interval(x_(axis, i)) - Interval(x_(axis, j));
                const Interval speed = Interval(d_(axis, i)) - Interval(d_(axis, j));
                height += Interval(n[axis]) * (start + Interval(t) * speed);
            }
            return height.inf() > least.sup();
        });
    }

private:
    std::vector<std::array<int, 2>> corners_;
    Stencil x_, d_;
};

} // namespace

bool surely_keep_gap(StencilKind kind, const Stencil& x, const Stencil& d, double gap, double end) {
    constexpr int most_pieces = 20000;
    const MovingDifferences differences(kind, x, d);
    std::vector<std::array<double, 2>> pieces = {{0, end}};
    for (int count = 0; count < most_pieces; ++count) {
        if (pieces.empty())
            return true;
        const auto [from, to] = pieces.back();
        pieces.pop_back();
        const double middle = 0.5 * (from + to);
        const bool proved = std::ranges::any_of(std::array{to, from, middle}, [&, from = from, to = to](double t) {
            const Vec3 n = differences.furthest_direction_at(t).unit;
            const CGAL::Protect_FPU_rounding<> upwards;
            return differences.surely_beyond(gap, n, from) && differences.surely_beyond(gap, n, to);
        });
        if (proved)
            continue;
        if (!(from < middle && middle < to))
            return false;
        pieces.push_back({middle, to});
        pieces.push_back({from, middle});
    }
    return false;
}

} // namespace plisse
