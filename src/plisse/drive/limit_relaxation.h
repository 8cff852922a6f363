#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <plisse/base/context.h>
#include <plisse/model/discretization.h>

namespace plisse {

struct LimitRelaxationResult {
    bool within = true;  ///< whether every face is within its limit now
    int over_limit = 0;  ///< faces that were not
    int iterations = 0;  ///< of Newton's method
    std::string message; ///< which face is not within, and where
};

/// Brings an intersection-free state of a level within the strain limits of its bodies (PSQ section 4.4.5): minimises
/// elasticity, contact and the barrier of limits that are raised to what there is, and lowers them as the stretches
/// shrink, first over the vertices that are new on the level, then over all free unknowns, then over handles' vertices
/// too. Never makes an intersection, and no face that has room below its limit loses it. Does nothing where all are
/// within. is_new: per vertex of the level. stiffness_factor: of the contact barrier.
LimitRelaxationResult relax_to_strain_limits(const Discretization& discretization, int level,
                                             const std::vector<std::uint8_t>& is_new, Positions& x, Context& context,
                                             double stiffness_factor = 1);

} // namespace plisse
