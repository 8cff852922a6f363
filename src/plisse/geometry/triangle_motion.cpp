#include <plisse/geometry/triangle_motion.h>

#include <Eigen/Geometry>

namespace plisse {

// The doubled area is |N(s)| with N = n0 + s n1 + s^2 n2, whose speed is at most |n1| + 2 |n2| on [0, 1]. Advancing by
// (distance to the floor) / (that bound) can never pass the floor, as in conservative advancement.
double regular_step(const Vec3& e1, const Vec3& e2, const Vec3& d1, const Vec3& d2) {
    constexpr double kept_share = 0.1;
    constexpr double near_enough = 0.02;
    constexpr int most_advances = 200;
    const Vec3 n0 = e1.cross(e2);
    const Vec3 n1 = e1.cross(d2) + d1.cross(e2);
    const Vec3 n2 = d1.cross(d2);
    const double area = n0.norm();
    if (!(area > 0))
        return 0;
    const double floor = kept_share * area;
    const double speed = n1.norm() + 2 * n2.norm();
    double s = 0;
    double room = area - floor;
    for (int advance = 0; advance < most_advances && room > near_enough * area; ++advance) {
        if (room >= speed * (1 - s))
            return 1;
        s += room / speed;
        room = (n0 + s * (n1 + s * n2)).norm() - floor;
    }
    return s;
}

} // namespace plisse
