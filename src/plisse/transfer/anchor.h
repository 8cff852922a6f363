#pragma once

#include <plisse/base/types.h>

namespace plisse {

/// Where a fine vertex sits on a coarser mesh: a face of it and barycentric weights (>= 0, sum 1). A fine vertex that
/// no face uses has no anchor (face -1).
struct Anchor {
    int face = -1;
    Vec3 weights = Vec3::Zero();
};

} // namespace plisse
