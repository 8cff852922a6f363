#include <plisse/geometry/ccd.h>

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace plisse {

namespace {

constexpr int most_iterations = 2000;

int size_of_first(StencilKind kind) {
    return kind == StencilKind::point_triangle ? 1 : 2;
}

double largest_number(const Stencil& x, const Stencil& d) {
    return x.cwiseAbs().maxCoeff() + d.cwiseAbs().maxCoeff();
}

/// Bounds the rounding of heights below and of x + t d for t in [0, 1], as a solver computes it: in units of the
/// largest number times half an epsilon, 21 of the points in a height, 21 of the dot products, 7 of the length of n,
/// 17 of the times, and 7 of the solver.
double rounding_bound(const Stencil& x, const Stencil& d) {
    return 40 * std::numeric_limits<double>::epsilon() * largest_number(x, d);
}

/// How fast the two primitives can approach: no point of one moves faster relative to a point of the other.
double speed_bound(StencilKind kind, const Stencil& d) {
    const int first_size = size_of_first(kind);
    double squared = 0;
    for (int i = 0; i < first_size; ++i)
        for (int j = first_size; j < 4; ++j)
            squared = std::max(squared, (d.col(i) - d.col(j)).squaredNorm());
    return std::sqrt(squared);
}

/// Time for which all corner pairs stay more than `gap` apart along n, from heights at time 0 and their speeds; 0 when
/// they are not so at time 0.
double time_above(StencilKind kind, double gap, const Vec3& n, const Stencil& x, const Stencil& d) {
    const int first_size = size_of_first(kind);
    const Eigen::RowVector4d heights = n.transpose() * x, speeds = n.transpose() * d;
    double time = std::numeric_limits<double>::infinity();
    for (int i = 0; i < first_size; ++i)
        for (int j = first_size; j < 4; ++j) {
            const double spare = heights[i] - heights[j] - gap, closing = speeds[j] - speeds[i];
            if (!(spare > 0))
                return 0;
            if (closing > 0)
                time = std::min(time, spare / closing);
        }
    return time;
}

/// The unit vector square to both primitives that points from the second to the first: however thin the triangle or
/// near parallel the edges, all corners of a primitive are at one height along it but for a rounding.
Vec3 common_normal(StencilKind kind, const Stencil& x) {
    const bool edges = kind == StencilKind::edge_edge;
    const Vec3 u = edges ? x.col(1) - x.col(0) : x.col(2) - x.col(1);
    const Vec3 v = x.col(3) - x.col(edges ? 2 : 1);
    const Vec3 normal = cross_square(u, v).normalized();
    return normal.dot(x.col(0) - x.col(3)) < 0 ? Vec3(-normal) : normal;
}

} // namespace

bool keeps_apart(StencilKind kind, const Stencil& x, const Stencil& d, double distance, double gap, double end) {
    // Distances of edges that count as parallel are too large by half their sine at most.
    constexpr double distance_error = 2e-10;
    return distance - gap - distance_error * largest_number(x, d) > end * speed_bound(kind, d);
}

double safe_step(StencilKind kind, const Stencil& x, const Stencil& d, double gap, double end) {
    if ((d.colwise() - d.col(0)).isZero(0))
        return end;
    // Squares of squares neither overflow nor vanish near 1.
    const int exponent = std::ilogb(largest_number(x, d));
    if (std::abs(exponent) > 100) {
        const auto scaled = [&](const Stencil& s) -> Stencil {
            return s.unaryExpr([&](double number) { return std::ldexp(number, -exponent); });
        };
        return safe_step(kind, scaled(x), scaled(d), std::ldexp(gap, -exponent), end);
    }
    // Motion relative to the first point: common translation, however fast, is no motion.
    const Stencil start = x.colwise() - x.col(0), motion = d.colwise() - d.col(0);
    const double kept = gap + rounding_bound(x, d);
    const double speed = speed_bound(kind, motion);
    double t = 0, spare_at_start = -1;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        const Stencil now = start + t * motion;
        const Separation s = separate(kind, now);
        const double distance = std::sqrt(s.squared_distance), spare = distance - kept;
        if (iteration == 0)
            spare_at_start = spare;
        if (!(spare > ccd_tolerance * spare_at_start) || !(spare_at_start > 0))
            return t;
        double step = time_above(kind, kept, s.offset / distance, now, motion);
        if (step < spare / speed) // the direction has lost its digits
            step = std::max(step, time_above(kind, kept, common_normal(kind, now), now, motion));
        if (t + step >= end)
            return end;
        if (!(step > 0))
            return t;
        t += step;
    }
    return t;
}

} // namespace plisse
