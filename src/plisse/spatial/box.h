#pragma once

#include <algorithm>
#include <limits>

#include <plisse/base/types.h>

namespace plisse {

/// Axis-aligned box; the default one is empty.
struct Box {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = Vec3::Constant(-std::numeric_limits<double>::infinity());

    void include(const Vec3& point) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
    }
    void include(const Box& box) {
        low = low.cwiseMin(box.low);
        high = high.cwiseMax(box.high);
    }
    Box inflated(double margin) const { return {(low.array() - margin).matrix(), (high.array() + margin).matrix()}; }
    bool overlaps(const Box& box) const {
        return (low.array() <= box.high.array()).all() && (box.low.array() <= high.array()).all();
    }
    Vec3 center() const { return 0.5 * (low + high); }
    double diagonal() const { return (high - low).norm(); }
};

/// Box of all columns.
inline Box bounding_box(const ConstPositions& points) {
    Box box;
    for (int i = 0; i < points.cols(); ++i)
        box.include(points.col(i));
    return box;
}

} // namespace plisse
