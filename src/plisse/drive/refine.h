#pragma once

#include <plisse/base/context.h>
#include <plisse/drive/recorder.h>
#include <plisse/model/discretization.h>

namespace plisse {

struct RefineResult {
    Positions positions; ///< of the next level, intersection-free and within strain limits; empty unless complete
    bool complete = false;
    bool cancelled = false;
    std::string message; ///< why it is not complete: what could not be split, or is stretched too far
    RefinementReport report;
};

/// Brings an intersection-free state of level `from` to level `from` + 1, near its prolongation and intersection-free
/// at every moment (PSQ algorithms 2 and 3): batch by batch the collapses between the levels are undone, the new
/// vertices perturbed apart, moved toward their targets under CCD, and patches that end too tight relaxed; or the level
/// is subdivided (subdivide_state()). Then the next level is brought within its strain limits (algorithm 2, line 9).
/// t: time of the scripts, which say where obstacles and handles should be. stiffness_factor: of the contact barrier.
RefineResult refine(const Discretization& discretization, int from, const Positions& x, double t, Context& context,
                    double stiffness_factor = 1);

} // namespace plisse
