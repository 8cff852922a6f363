#pragma once

#include <plisse/geometry/distance.h>

namespace plisse {

/// Takes the kink out of the distance of two edges where they turn parallel (IPC, Li et al. 2020, section 5.2). With
/// edges u = a1 - a0 and v = b1 - b0, c = |u x v|^2 and a threshold e on it:
///   m(c) = (2 - c/e) c/e below e, else 1;  e = 1e-3 |u|^2 |v|^2 of the edges at rest.
struct Mollifier {
    double value = 1, first = 0, second = 0; ///< m, dm/dc, d2m/dc2
};

inline constexpr double mollifier_threshold_factor = 1e-3;

Mollifier mollify(double cross_squared, double threshold);

/// c = |u x v|^2 of an edge-edge stencil, m^4.
double cross_squared(const Stencil& x);
Vec12 cross_squared_gradient(const Stencil& x);
Mat12 cross_squared_hessian(const Stencil& x);

} // namespace plisse
