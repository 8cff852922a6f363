#include <plisse/geometry/mollifier.h>

#include <Eigen/Geometry>

namespace plisse {

Mollifier mollify(double cross_squared, double threshold) {
    if (!(cross_squared < threshold))
        return {};
    const double share = cross_squared / threshold;
    return {(2 - share) * share, 2 * (1 - share) / threshold, -2 / (threshold * threshold)};
}

double cross_squared(const Stencil& x) {
    const Vec3 u = x.col(1) - x.col(0), v = x.col(3) - x.col(2);
    return u.cross(v).squaredNorm();
}

Vec12 cross_squared_gradient(const Stencil& x) {
    const Vec3 u = x.col(1) - x.col(0), v = x.col(3) - x.col(2);
    const Vec3 n = u.cross(v);
    const Vec3 by_u = 2 * v.cross(n), by_v = 2 * n.cross(u);
    Vec12 gradient;
    gradient.segment<3>(0) = -by_u;
    gradient.segment<3>(3) = by_u;
    gradient.segment<3>(6) = -by_v;
    gradient.segment<3>(9) = by_v;
    return gradient;
}

Mat12 cross_squared_hessian(const Stencil& x) {
    const Vec3 u = x.col(1) - x.col(0), v = x.col(3) - x.col(2);
    const Mat3 uu = 2 * (v.squaredNorm() * Mat3::Identity() - v * v.transpose());
    const Mat3 vv = 2 * (u.squaredNorm() * Mat3::Identity() - u * u.transpose());
    const Mat3 uv = 4 * u * v.transpose() - 2 * v * u.transpose() - 2 * u.dot(v) * Mat3::Identity();
    Mat12 hessian;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
            const double sign = i == j ? 1 : -1;
            hessian.block<3, 3>(3 * i, 3 * j) = sign * uu;
            hessian.block<3, 3>(3 * i + 6, 3 * j + 6) = sign * vv;
            hessian.block<3, 3>(3 * i, 3 * j + 6) = sign * uv;
            hessian.block<3, 3>(3 * j + 6, 3 * i) = sign * uv.transpose();
        }
    return hessian;
}

} // namespace plisse
