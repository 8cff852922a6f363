#pragma once

#include <array>

#include <plisse/base/types.h>

namespace plisse {

using Triangle = std::array<Vec3, 3>;

/// Squared distance of two triangles that do not intersect, m^2.
double triangle_distance_squared(const Triangle& a, const Triangle& b);

/// Whether one of the planes through a side of either triangle, along its normal or across it, shows that they are
/// more than `gap` apart. Fast, and never wrong when it says so; it may miss triangles that are apart. The normals are
/// unit vectors.
bool surely_apart(const Triangle& a, const Vec3& normal_a, const Triangle& b, const Vec3& normal_b, double gap);

} // namespace plisse
