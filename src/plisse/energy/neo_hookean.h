#pragma once

#include <plisse/base/types.h>

namespace plisse {

using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

/// Lame parameters, Pa. The neo-Hookean membrane per unit of rest volume, as a function of the 3x2 deformation gradient
/// F with C = F^T F and J = sqrt(det C):
///   w = mu/2 (tr C - 2 - 2 ln J) + lambda/2 (ln J)^2                                      (DESIGN.md section 4)
/// w, its stress and its Hessian vanish or stay accurate to round-off *relative to the strain* near rest, because they
/// are evaluated from C - I: a line search compares energies of strains of 1e-6.
struct Lame {
    double mu = 0;
    double lambda = 0;
};

/// Of a thin sheet in plane stress: mu = E/(2(1+nu)), lambda = E nu/(1-nu^2). E in Pa, nu in (-1, 0.5].
Lame plane_stress_lame(double youngs_modulus, double poisson_ratio);

/// w, Pa; +infinity where det C is not positive.
double neo_hookean_value(const Mat32& F, const Lame& lame);

/// P = dw/dF, Pa; det C must be positive.
Mat32 neo_hookean_stress(const Mat32& F, const Lame& lame);

/// Singular values of F, the larger first: the principal stretches.
Vec2 principal_stretches(const Mat32& F);

/// The eigen-system of d2w/dF2 in closed form. With F = s1 u1 v1^T + s2 u2 v2^T and n = u1 x u2 its eigen-vectors are
///   the span of u1 v1^T and u2 v2^T            `stretch`, a 2x2 matrix
///   (u1 v2^T - u2 v1^T)/sqrt2                  `twist`
///   (u1 v2^T + u2 v1^T)/sqrt2                  `flip`
///   n v1^T and n v2^T                          `lift`
/// All values are free of differences of s1 and s2, so nothing happens where these coincide.
struct NeoHookeanModes {
    Mat3 left;  ///< columns u1, u2, n
    Mat2 right; ///< columns v1, v2
    Mat2 stretch;
    double twist, flip;
    Vec2 lift;
};
/// project: eigenvalues below zero become zero. det C must be positive.
NeoHookeanModes neo_hookean_modes(const Mat32& F, const Lame& lame, bool project);

/// d2w/dF2 over the entries of F column by column, Pa.
Mat6 neo_hookean_hessian(const NeoHookeanModes& modes);

/// Hessian over the three corners of a triangle, 9x9, where F = (x1 - x0, x2 - x0) inverse; times `scale`.
Mat9 pull_back(const NeoHookeanModes& modes, const Mat2& inverse, double scale);

} // namespace plisse
