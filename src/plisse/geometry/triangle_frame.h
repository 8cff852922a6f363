#pragma once

#include <plisse/base/types.h>

namespace plisse {

/// A rest triangle in its own plane: first edge along the first axis, third corner at a positive second coordinate.
struct TriangleFrame {
    Mat2 inverse; ///< of the 2x2 matrix whose columns are the edges x1 - x0 and x2 - x0 in the plane, 1/m
    double area;  ///< m^2
};

/// Frame of a triangle of positive area (PSQ 2023, footnote 2).
TriangleFrame triangle_frame(const Vec3& x0, const Vec3& x1, const Vec3& x2);

/// F = (x1 - x0, x2 - x0) inverse: how the rest triangle of that frame is deformed, 3x2.
inline Mat32 deformation_gradient(const Mat2& inverse, const Vec3& x0, const Vec3& x1, const Vec3& x2) {
    Mat32 edges;
    edges << x1 - x0, x2 - x0;
    return edges * inverse;
}

} // namespace plisse
