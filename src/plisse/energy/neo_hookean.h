#pragma once

#include <plisse/energy/stretch_modes.h>

namespace plisse {

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

/// The eigen-system of d2w/dF2 in closed form. project: eigenvalues below zero become zero. det C must be positive.
StretchModes neo_hookean_modes(const Mat32& F, const Lame& lame, bool project);

} // namespace plisse
