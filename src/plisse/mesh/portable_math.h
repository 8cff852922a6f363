#pragma once

#include <cmath>

#include <plisse/base/types.h>

namespace plisse {

/// Arithmetic of the generators, in one fixed order of IEEE additions, products and square roots, so that a mesh has
/// the same bits on every machine: vectorised reductions and the standard library's trigonometry do not promise that.
inline double dot(const Vec3& a, const Vec3& b) {
    return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}
inline double length(const Vec3& a) {
    return std::sqrt(dot(a, a));
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

/// Twice the area of a triangle along its normal.
inline Vec3 area_vector(const Vec3& a, const Vec3& b, const Vec3& c) {
    return cross(b - a, c - a);
}

inline constexpr double pi = 3.14159265358979323846;

struct CosSin {
    double cos, sin;
};

/// Cosine and sine of 2 pi turns, |turns| < 2^50. Quarter turns give exact zeros and ones, and eighths of the circle
/// mirror each other exactly. Error below 2^-52.
CosSin cos_sin_turns(double turns);

} // namespace plisse
