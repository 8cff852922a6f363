#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// Writes an OBJ: all vertices in their order, texture coordinates and colours where the mesh has them, and the faces
/// in their order, a group for each run of faces of one part. Throws std::runtime_error when it cannot be written; what
/// is there then is not whole.
void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh, std::span<const int> face_part,
               std::span<const std::string> part_names);

} // namespace plisse
