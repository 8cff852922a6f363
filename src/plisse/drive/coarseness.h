#pragma once

#include <span>

#include <plisse/base/types.h>
#include <plisse/model/fold_estimate.h>

namespace plisse {

/// How coarse a mesh is for the shape it has taken, per vertex: the root mean square of the angles by which the edges
/// around the vertex, and those opposite to it, have been bent from rest, over most_turn. Above 1 the mesh is too
/// coarse there. 0 at rest, after a rigid motion, and where no edge has two faces. Of ten scenes the mean distance of a
/// preview from the final result, once the rigid motion of each neighbourhood is taken away, is the bulge that
/// most_turn speaks of (docs/decisions/0023-how-coarse-is-sound.md). positions and rest: m.
VecX coarseness(const Positions& rest, const Positions& positions, std::span<const Face> faces);

/// Where a mesh is too coarse.
struct TooCoarse {
    double share = 0;          ///< of the area at rest, where coarseness is above 1
    double worst = 0;          ///< the largest coarseness
    double turn = 0;           ///< rad, there
    double edge = 0;           ///< m, mean length at rest of the edges there
    Vec3 place = Vec3::Zero(); ///< m, where that vertex is
};

/// Of the vertices of these faces. The lowest of equally bad places is the worst.
TooCoarse find_too_coarse(const Positions& rest, const Positions& positions, std::span<const Face> faces);

} // namespace plisse
