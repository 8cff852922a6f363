#pragma once

#include <plisse/model/discretization.h>

namespace plisse {

struct SubdividedState {
    Positions positions; ///< of the next level
    int new_vertices = 0;
    int stopped_vertices = 0; ///< held short of their targets
    double min_gap = 0;       ///< m, over pairs that may come near; infinity when there are none
};

/// Brings an intersection-free state of level `from` to the level that is `from` subdivided (PSQ section 3.3): new
/// vertices begin in the middle of their edges, where the surface is the one that it was, so nothing meets; then all
/// move toward their targets under CCD. Pairs that limit the way stop their vertices alone, where progressive cloth
/// simulation stops all. t: time of the scripts.
SubdividedState subdivide_state(const Discretization& discretization, int from, const Positions& x, double t);

} // namespace plisse
