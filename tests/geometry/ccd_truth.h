#pragma once

#include <plisse/geometry/ccd.h>

#include "geometry/exact_polynomial.h"

namespace plisse {

/// When two primitives that move from x to x + t d, t in [0, 1], first touch. Decided in whole numbers, so neither
/// rounding nor degeneracy can make it wrong; shares no code with the solver.
///
/// The primitives can touch only while their four points are coplanar: at the roots of a cubic f in t. At each root the
/// signs of other polynomials tell whether they do. When f is zero throughout, touching begins at time 0 or at a root
/// of one of those.
class FirstContact {
public:
    FirstContact(StencilKind kind, const Stencil& x, const Stencil& d);

    bool happens() const { return !times_.empty(); }
    /// Whether they touch at some moment in [0, t], t in [0, 1].
    bool by(double t);
    /// To within 2^-60. happens() must hold.
    double approximation();

private:
    std::vector<Root> times_; ///< moments of touching; the first is among them
};

/// Whether planes prove, in interval arithmetic, that the two primitives stay apart by more than `gap` >= 0 at every
/// moment of [0, end]. A proof always exists when they do so by a few roundings.
bool surely_keep_gap(StencilKind kind, const Stencil& x, const Stencil& d, double gap, double end);

} // namespace plisse
