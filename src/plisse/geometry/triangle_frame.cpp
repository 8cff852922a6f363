#include <plisse/geometry/triangle_frame.h>

#include <cassert>

#include <Eigen/Geometry>

namespace plisse {

TriangleFrame triangle_frame(const Vec3& x0, const Vec3& x1, const Vec3& x2) {
    const Vec3 e1 = x1 - x0;
    const Vec3 e2 = x2 - x0;
    const double length = e1.norm();
    const double twice_area = e1.cross(e2).norm();
    assert(twice_area > 0);
    const double height = twice_area / length;
    TriangleFrame frame;
    frame.inverse << 1 / length, -e1.dot(e2) / (length * twice_area), 0, 1 / height;
    frame.area = twice_area / 2;
    return frame;
}

} // namespace plisse
