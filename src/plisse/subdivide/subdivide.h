#pragma once

#include <plisse/decimate/hierarchy.h>
#include <plisse/subdivide/loop_step.h>

namespace plisse {

/// What is subdivided: all bodies and obstacles in one mesh.
struct SubdivisionInput {
    Positions rest; ///< m
    LabelledSurface surface;
    std::vector<std::uint8_t> kept_part; ///< per part: the same on every level; empty: none
    LabelBetween label_between;          ///< for two labels that are not -1
};

/// Nested levels made from coarse to fine: level 0 is the input, every other the one before, divided by loop_step (PSQ
/// section 3.3). Anchors are those of the midpoints of edges, with weights that are exact. levels >= 1.
Hierarchy subdivide(const SubdivisionInput& input, int levels);

/// The next finer level's positions by the rule of its rest positions. level: of a subdivided hierarchy, below the
/// finest.
inline Positions subdivided_positions(const Hierarchy& hierarchy, int level, const Positions& x) {
    return x * hierarchy.levels[static_cast<std::size_t>(level)].subdivision.transpose();
}

} // namespace plisse
