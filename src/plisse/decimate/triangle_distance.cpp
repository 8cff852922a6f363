#include <plisse/decimate/triangle_distance.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace plisse {

namespace {

double point_segment_squared(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 edge = b - a;
    const double length_squared = edge.squaredNorm();
    const double t = length_squared > 0 ? std::clamp((p - a).dot(edge) / length_squared, 0.0, 1.0) : 0.0;
    return (p - a - t * edge).squaredNorm();
}

double point_triangle_squared(const Vec3& p, const Triangle& t) {
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double normal_squared = normal.squaredNorm();
    bool above = normal_squared > 0; // p projects into the triangle
    for (std::size_t k = 0; k < 3 && above; ++k)
        above = (t[(k + 1) % 3] - t[k]).cross(p - t[k]).dot(normal) >= 0;
    if (above) {
        const double height = (p - t[0]).dot(normal);
        return height * height / normal_squared;
    }
    return std::min({point_segment_squared(p, t[0], t[1]), point_segment_squared(p, t[1], t[2]),
                     point_segment_squared(p, t[2], t[0])});
}

/// Squared distance where both segments are nearest inside; infinity where an end is nearest.
double inner_segments_squared(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    const Vec3 u = q - p, v = s - r, w = p - r;
    const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), uw = u.dot(w), vw = v.dot(w);
    const double determinant = uu * vv - uv * uv;
    const double along_u = uv * vw - vv * uw, along_v = uu * vw - uv * uw;
    if (!(along_u > 0 && along_u < determinant && along_v > 0 && along_v < determinant))
        return std::numeric_limits<double>::infinity();
    return (w + along_u / determinant * u - along_v / determinant * v).squaredNorm();
}

/// Whether `b` is beyond the sides of `a`, or off its plane, by more than `gap`.
bool apart_from(const Triangle& a, const Vec3& normal, const Triangle& b, double gap) {
    const std::array<Vec3, 3> d{b[0] - a[0], b[1] - a[0], b[2] - a[0]};
    const double h0 = d[0].dot(normal), h1 = d[1].dot(normal), h2 = d[2].dot(normal);
    if (std::min({h0, h1, h2}) > gap || std::max({h0, h1, h2}) < -gap)
        return true;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 edge = a[(k + 1) % 3] - a[k];
        const Vec3 outward = edge.cross(normal);
        const double least =
            std::min({(b[0] - a[k]).dot(outward), (b[1] - a[k]).dot(outward), (b[2] - a[k]).dot(outward)});
        if (least > 0 && least * least > gap * gap * edge.squaredNorm())
            return true;
    }
    return false;
}

} // namespace

double triangle_distance_squared(const Triangle& a, const Triangle& b) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k)
        least = std::min({least, point_triangle_squared(a[k], b), point_triangle_squared(b[k], a)});
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t m = 0; m < 3; ++m)
            least = std::min(least, inner_segments_squared(a[k], a[(k + 1) % 3], b[m], b[(m + 1) % 3]));
    return least;
}

bool surely_apart(const Triangle& a, const Vec3& normal_a, const Triangle& b, const Vec3& normal_b, double gap) {
    return apart_from(a, normal_a, b, gap) || apart_from(b, normal_b, a, gap);
}

} // namespace plisse
