#pragma once

#include <limits>

#include <plisse/model/discretization.h>

namespace plisse {

/// How far a preview is from the finest result: between the vertices of bodies on the finest level, the preview being
/// prolonged to it, and moved rigidly to where that is least in the mean of squares. In m; infinite while not known.
struct PreviewDistance {
    double mean = std::numeric_limits<double>::infinity(), largest = std::numeric_limits<double>::infinity();
};

/// Of positions on a level from those on the finest.
PreviewDistance preview_distance(const Discretization& discretization, int level, const Positions& preview,
                                 const Positions& finest);

} // namespace plisse
