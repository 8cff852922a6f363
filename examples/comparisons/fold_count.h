#pragma once

#include <span>

#include <plisse/base/types.h>

namespace plisse::comparisons {

/// Where a body is cut at rest.
struct Plane {
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
};

/// Folds along the curves in which the plane cuts the mesh at rest. Walked along a curve, the surface turns about the
/// plane's normal, to one side and back; every turn that is taken back by more than 20 degrees counts as half a fold.
int count_folds(const Positions& rest, std::span<const Face> faces, const Plane& plane, const Positions& x);

} // namespace plisse::comparisons
