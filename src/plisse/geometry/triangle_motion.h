#pragma once

#include <plisse/base/types.h>

namespace plisse {

/// Largest alpha in [0, 1] up to which a triangle with edges e1 + s d1 and e2 + s d2 keeps at least a tenth of its
/// area, for all s in [0, alpha]. Never an overestimate; 0 for a triangle without area.
double regular_step(const Vec3& e1, const Vec3& e2, const Vec3& d1, const Vec3& d2);

} // namespace plisse
