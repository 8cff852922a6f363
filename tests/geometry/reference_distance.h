#pragma once

#include <array>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include <plisse/geometry/ccd.h>

namespace plisse {

using LongVec3 = Eigen::Matrix<long double, 3, 1>;

/// The corners of the set of differences between points of two primitives, in order around it, as corners {i, j}.
inline std::vector<std::array<int, 2>> difference_corners(StencilKind kind) {
    if (kind == StencilKind::point_triangle)
        return {{0, 1}, {0, 2}, {0, 3}};
    return {{0, 2}, {1, 2}, {1, 3}, {0, 3}};
}

struct Direction {
    Vec3 unit = Vec3::Zero();
    long double distance = 0; ///< of all corners from the origin, along it
};

/// The direction from the origin in which the corners of a flat convex polygon, a triangle or a parallelogram, are
/// furthest. If the origin is not in it, that direction points to the nearest corner, square to an edge, or to the
/// plane.
inline Direction furthest_direction(const std::vector<LongVec3>& corners) {
    Direction best;
    const auto consider = [&](const LongVec3& n) {
        const long double length = n.stableNorm();
        if (!(length > 0))
            return;
        long double least = std::numeric_limits<long double>::infinity();
        for (const LongVec3& q : corners)
            least = std::min(least, (n / length).dot(q));
        if (least > best.distance)
            best = {(n / length).cast<double>(), least};
    };
    const std::size_t size = corners.size();
    for (std::size_t k = 0; k < size; ++k) {
        const LongVec3 &q = corners[k], edge = (corners[(k + 1) % size] - q).stableNormalized();
        consider(q);
        const LongVec3 foot = q - q.dot(edge) * edge;
        consider(foot - foot.dot(edge) * edge); // again, or a near foot is square only to the digits of a far corner
    }
    const LongVec3 first = (corners[1] - corners[0]).stableNormalized(), other = corners[size - 1] - corners[0];
    const LongVec3 normal = first.cross((other - other.dot(first) * first).stableNormalized());
    consider(normal);
    consider(-normal);
    return best;
}

/// From corner j to corner i.
inline LongVec3 difference(const Stencil& x, int i, int j) {
    return x.col(i).cast<long double>() - x.col(j).cast<long double>();
}

/// The distance of two primitives in extended precision, by another way than the solver's: the largest, over a few
/// directions one of which is that between the closest points, of the distance along the direction. Never negative.
inline double reference_distance(StencilKind kind, const Stencil& x) {
    std::vector<LongVec3> points;
    for (const auto& [i, j] : difference_corners(kind))
        points.push_back(difference(x, i, j));
    return static_cast<double>(furthest_direction(points).distance);
}

} // namespace plisse
