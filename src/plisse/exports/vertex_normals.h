#pragma once

#include <span>

#include <plisse/base/types.h>

namespace plisse {

/// Unit normals at the vertices: the mean over the faces around each, weighted by their areas; +y where that is
/// nothing.
Eigen::Matrix3Xf vertex_normals(const ConstPositions& positions, std::span<const Face> faces);

} // namespace plisse
