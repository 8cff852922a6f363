#pragma once

#include <plisse/geometry/distance.h>

namespace plisse {

/// What one pair of primitives weighs in the contact energy.
struct PairParameters {
    double scale = 0;               ///< area weight * stiffness * activation distance, J
    double activation_squared = 0;  ///< Dhat, m^2
    double mollifier_threshold = 0; ///< of mollify(), m^4; 0 for point-triangle pairs
};

/// Energy of one pair, E = scale * m(c) * b(D / Dhat), with the squared distance D of `separation` (of the stencil x),
/// the mollifier m and the barrier b. J.
double pair_energy(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// dE/dX in the order of the stencil, N.
Vec12 pair_gradient(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// d2E/dX2, N/m.
Mat12 pair_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// The positive semi-definite matrix nearest to d2E/dX2. Without the mollifier all of it but negative multiples of
/// identities lives in 1 + 2 freedom directions (one, three or five), where it is projected; with it, in the nine that
/// are left when translations are taken off.
Mat12 pair_projected_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// The part of d2E/dX2 that is left when the mollifier and the direction between the closest points stand still:
/// m E''(d) dd dd^T in the distance d. It is positive semi-definite.
Mat12 pair_gauss_newton_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x);

} // namespace plisse
