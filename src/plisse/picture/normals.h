#pragma once

#include <array>
#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

using CornerNormals = std::array<Eigen::Vector3f, 3>;

/// Unit normals at the corners of every face: the area-weighted mean over those faces around the vertex whose own
/// normals lie within `crease_deg` of the face's, so that a cloth looks smooth and a box keeps its edges. Zero for
/// faces that are degenerate or not finite.
std::vector<CornerNormals> corner_normals(const ConstPositions& positions, std::span<const Face> faces,
                                          double crease_deg);

} // namespace plisse
