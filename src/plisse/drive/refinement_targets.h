#pragma once

#include <plisse/model/discretization.h>

namespace plisse {

/// Where the vertices of the level after `from` should go, when x are positions of level `from`: to their prolongation,
/// and where scripts prescribe them, to where those have them at time t.
Positions refinement_targets(const Discretization& discretization, int from, const Positions& x, double t);

} // namespace plisse
