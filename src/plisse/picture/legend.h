#pragma once

#include <plisse/picture/image.h>
#include <plisse/picture/scalars.h>

namespace plisse {

inline constexpr int legend_width = 190; ///< pixels

/// Draws the colour map as a bar with the values at its ends, within legend_width pixels from `left`.
void draw_legend(Image& image, int left, const Scalars& scalars);

} // namespace plisse
