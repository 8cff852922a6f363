#pragma once

#include <plisse/base/types.h>

namespace plisse {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

/// Singular values of F (3x2), the larger first: the principal stretches.
Vec2 principal_stretches(const Mat32& F);

/// F = s1 u1 v1^T + s2 u2 v2^T with s1 >= s2 and n = u1 x u2.
struct PrincipalFrame {
    Mat3 left;  ///< columns u1, u2, n
    Mat2 right; ///< columns v1, v2
    Vec2 stretches;
};
/// det C must be positive.
PrincipalFrame principal_frame(const Mat32& F);

/// The eigen-system of d2w/dF2 of an isotropic w(s1, s2). Its eigen-vectors are
///   the span of u1 v1^T and u2 v2^T            `stretch`, a 2x2 matrix: d2w / (ds_i ds_j)
///   (u1 v2^T - u2 v1^T)/sqrt2                  `twist`: (w_1 + w_2)/(s1 + s2)
///   (u1 v2^T + u2 v1^T)/sqrt2                  `flip`: (w_1 - w_2)/(s1 - s2)
///   n v1^T and n v2^T                          `lift`: w_1/s1 and w_2/s2
/// with w_i = dw/ds_i. Those who fill it find `flip` without a difference of s1 and s2, so nothing happens where these
/// coincide.
struct StretchModes {
    PrincipalFrame frame;
    Mat2 stretch;
    double twist, flip;
    Vec2 lift;
};

/// d2w/dF2 over the entries of F column by column.
Mat6 hessian(const StretchModes& modes);

/// Hessian over the three corners of a triangle, 9x9, where F = (x1 - x0, x2 - x0) inverse; times `scale`.
Mat9 pull_back(const StretchModes& modes, const Mat2& inverse, double scale);

} // namespace plisse
