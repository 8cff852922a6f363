#pragma once

namespace plisse {

/// How the motion of a coarse mesh is carried to a finer one.
enum class ProlongationOperator {
    shell,     ///< anchors plus offsets that turn with the coarse triangle (PSQ equations 4-9)
    intrinsic, ///< anchors alone (Liu et al. 2021): loses the rest shape
    blend,     ///< anchors plus offsets that turn with the coarse triangles around the anchor's corners too
    affine,    ///< best-fit affine maps, collapse by collapse (Liu and Jacobson 2019): linear
    loop       ///< the rule by which the levels were subdivided (Loop 1987; PSQ section 3.3): linear
};

} // namespace plisse
