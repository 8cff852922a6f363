#pragma once

#include <plisse/geometry/distance.h>

namespace plisse {

/// What one pair of primitives weighs in the contact energy.
struct PairParameters {
    double scale = 0;              ///< area weight * stiffness * activation distance, J; below 0 for pairs counted off
    double activation_squared = 0; ///< Dhat, m^2
    double least_squared = 0;      ///< D0 of the distance that is kept, m^2
    std::uint8_t ends = 0;         ///< of two edges, the ends that the mollifier goes by, one bit each; 0 for a point
};

/// Energy of one pair, E = scale * m * b((D - D0) / (Dhat - D0)), with the squared distance D of `separation` (of the
/// stencil x), the mollifier m of two edges and the barrier b (after C-IPC, Li et al. 2021, section 4.1). J; infinite
/// for D <= D0.
double pair_energy(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// How hard the two primitives press each other apart along the line of their closest points, N.
double pair_normal_force(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// dE/dX in the order of the stencil, N.
Vec12 pair_gradient(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// d2E/dX2, N/m.
Mat12 pair_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// A positive semi-definite matrix close to d2E/dX2 and not below it: see projected_hessian.
Mat12 pair_projected_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x);

/// The part of d2E/dX2 that is left when the mollifier and the direction between the closest points stand still:
/// m E''(d) dd dd^T in the distance d. It is positive semi-definite.
Mat12 pair_gauss_newton_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x);

} // namespace plisse
