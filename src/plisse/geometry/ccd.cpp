#include <plisse/geometry/ccd.h>

#include <cmath>
#include <limits>

namespace plisse {

namespace {

constexpr int most_iterations = 2000;

int size_of_first(StencilKind kind) {
    return kind == StencilKind::point_triangle ? 1 : 2;
}

/// Bounds the rounding of x + t d for t in [0, 1], as a solver computes it, and of the dot products below.
double rounding_bound(const Stencil& x, const Stencil& d) {
    const double largest = x.cwiseAbs().maxCoeff() + d.cwiseAbs().maxCoeff();
    return 8 * std::numeric_limits<double>::epsilon() * largest;
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

/// Time for which all corner pairs stay more than `gap` apart along n, from heights at time 0 and their speeds.
double time_above(StencilKind kind, double gap, const Vec3& n, const Stencil& x, const Stencil& d) {
    const int first_size = size_of_first(kind);
    const Eigen::RowVector4d heights = n.transpose() * x, speeds = n.transpose() * d;
    double time = std::numeric_limits<double>::infinity();
    for (int i = 0; i < first_size; ++i)
        for (int j = first_size; j < 4; ++j) {
            const double closing = speeds[j] - speeds[i];
            if (closing > 0)
                time = std::min(time, (heights[i] - heights[j] - gap) / closing);
        }
    return time;
}

} // namespace

bool keeps_apart(StencilKind kind, const Stencil& x, const Stencil& d, double distance, double gap, double end) {
    return distance - gap - rounding_bound(x, d) > end * speed_bound(kind, d);
}

double safe_step(StencilKind kind, const Stencil& x, const Stencil& d, double gap, double end) {
    // Motion relative to the first point: common translation, however fast, is no motion.
    const Stencil start = x.colwise() - x.col(0), motion = d.colwise() - d.col(0);
    if (motion.isZero(0))
        return end;
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
        // ACCD's step is the longer one only where n has lost its digits.
        const double step = std::max(spare / speed, time_above(kind, kept, s.offset / distance, now, motion));
        if (t + step >= end)
            return end;
        t += step;
    }
    return t;
}

} // namespace plisse
