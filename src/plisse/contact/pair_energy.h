#pragma once

#include <plisse/geometry/distance.h>

namespace plisse {

/// What one pair of primitives weighs in the contact energy.
struct PairParameters {
    double scale = 0;               ///< area weight * stiffness * activation distance, J
    double activation_squared = 0;  ///< Dhat, m^2
    double mollifier_threshold = 0; ///< of mollify(), m^4; 0 for point-triangle pairs
    double least_squared = 0;       ///< D0 of the distance that is kept, m^2
};

/// Energy of one pair, E = scale * m(c) * b((D - D0) / (Dhat - D0)), with the squared distance D of `separation` (of
/// the stencil x), the mollifier m and the barrier b (C-IPC, Li et al. 2021, section 4.1). J; infinite for D <= D0.
double pair_energy(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// How hard the two primitives press each other apart, -dE/dd with the distance d of `separation`. N.
double pair_normal_force(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// dE/dX in the order of the stencil, N.
Vec12 pair_gradient(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// d2E/dX2, N/m.
Mat12 pair_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// A positive semi-definite matrix close to d2E/dX2 and not below it. With orthonormal tangents t_k, slides v_k,
/// weights w, unit offset n and distance d, the Hessian without mollifier is (x is Kronecker's product)
///   E''(d) (w x n)(w x n)^T + c sum_k [d (w x t_k)(v_k x n)^T + its transpose + d^2 (v_k x n)(v_k x n)^T]
///   - c (w x m)(w x m)^T summed over the directions m across n and the tangents,      c = -2 dE/dD >= 0.
/// Each term is projected by itself: the first is positive, the last negative, and those of the sum are 2x2 matrices.
/// With the mollifier the nearest semi-definite matrix is found in the nine dimensions across translations.
Mat12 pair_projected_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// The part of d2E/dX2 that is left when the mollifier and the direction between the closest points stand still:
/// m E''(d) dd dd^T in the distance d. It is positive semi-definite.
Mat12 pair_gauss_newton_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x);

} // namespace plisse
