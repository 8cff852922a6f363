#pragma once

#include <vector>

#include <plisse/decimate/hierarchy.h>
#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// Attributes of the input's mesh on another level. A vertex takes the values at its place on the input (numbers that
/// are counts or codes: those of the nearest corner there), a face those of the input's face with its id, and a face's
/// corner those at its vertex's place, seen from the side of a seam that the input's face with the face's id is on.
std::vector<MeshAttribute> attributes_on(const Hierarchy& hierarchy, int level,
                                         const std::vector<MeshAttribute>& of_input);

} // namespace plisse
