#pragma once

#include <optional>
#include <string>
#include <vector>

#include <plisse/geometry/ccd.h>

namespace plisse {

/// Positions from one stencil to another.
struct Motion {
    StencilKind kind;
    Stencil from, to;
    Stencil by() const { return to - from; }
    Stencil at(double t) const { return from + t * by(); }
};

/// A motion with the exact time of first contact (none: never).
struct KnownMotion {
    std::string name;
    Motion motion;
    std::optional<double> contact;
    double tolerance = 1e-12; ///< of distances in double precision, relative to the one at the start
};

/// A point above the middle of a triangle.
Motion falling_point(const Vec3& from, const Vec3& to);

/// Hand-made motions: corners, edges, grazing passes, parallel, collinear and degenerate primitives, and hard queries
/// published with ipc-toolkit (tests/src/tests/ccd, commit b40e9c07).
const std::vector<KnownMotion>& known_motions();

} // namespace plisse
