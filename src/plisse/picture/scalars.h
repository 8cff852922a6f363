#pragma once

#include <span>
#include <string>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// A number per vertex or per face, shown as colour. What is not finite is shown grey.
struct Scalars {
    std::string name; ///< for the legend
    MeshAttribute::Domain domain = MeshAttribute::Domain::vertex;
    std::vector<double> values;
    double low = 0, high = 1; ///< values at the two ends of the colour map; low < high
};

/// Sets low and high to the range of the values that are finite and, where `counts` is not empty, counted; the share
/// `cut` of the largest values is left out of it, so that a few peaks do not darken the rest.
void fit_range(Scalars& scalars, const std::vector<bool>& counts, double cut);

/// Largest principal stretch of every face, from rest to deformed positions: the larger singular value of the
/// deformation gradient F (3x2). NaN for faces degenerate at rest.
std::vector<double> largest_stretches(const ConstPositions& rest, const ConstPositions& positions,
                                      std::span<const Face> faces);

/// Magnitude of the mean curvature at every vertex, 1/m: half the length of the cotangent Laplacian of the positions
/// over the mixed Voronoi area (Meyer, Desbrun, Schroeder, Barr 2003). Boundary vertices, where that is not a
/// curvature, get the mean of their neighbours further in, or NaN where there are none; so do vertices no face uses.
std::vector<double> mean_curvatures(const ConstPositions& positions, std::span<const Face> faces);

} // namespace plisse
