#pragma once

#include <Eigen/Cholesky>

#include <plisse/base/types.h>

namespace plisse {

/// Q(x) = x'Ax - 2 b'x + c: a weighted sum of squared distances to planes.
struct Quadric {
    Mat3 a = Mat3::Zero();
    Vec3 b = Vec3::Zero();
    double c = 0;

    Quadric& operator+=(const Quadric& other) {
        a += other.a;
        b += other.b;
        c += other.c;
        return *this;
    }

    double operator()(const Vec3& x) const { return x.dot(a * x) - 2 * b.dot(x) + c; }

    /// Where it is least; not finite or far away when A is singular.
    Vec3 minimiser() const { return a.llt().solve(b); }
};

inline Quadric operator+(Quadric p, const Quadric& q) {
    return p += q;
}

/// weight times the squared distance to the plane through `point` with unit normal `normal` (Garland and Heckbert
/// 1997).
inline Quadric plane_quadric(const Vec3& normal, const Vec3& point, double weight) {
    const double d = normal.dot(point);
    return {weight * normal * normal.transpose(), weight * d * normal, weight * d * d};
}

/// The same in expectation, the normal being uncertain by a standard deviation normal_sigma (dimensionless) and the
/// point by point_sigma (m) in each direction (Trettner and Kobbelt 2020). A is then regular.
inline Quadric probabilistic_plane_quadric(const Vec3& normal, const Vec3& point, double weight, double normal_sigma,
                                           double point_sigma) {
    const double s_n = normal_sigma * normal_sigma, s_p = point_sigma * point_sigma;
    Quadric q = plane_quadric(normal, point, weight);
    q.a.diagonal().array() += weight * s_n;
    q.b += weight * s_n * point;
    q.c += weight * (s_n * point.squaredNorm() + s_p + 3 * s_p * s_n);
    return q;
}

} // namespace plisse
