#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// Writes a binary little-endian PLY with double positions, atomically (a killed writer leaves the old file or none).
/// face_body, when not empty, becomes the int face property "body". Attributes of the mesh are written as properties.
/// Throws std::runtime_error when the file cannot be written.
void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, std::span<const int> face_body = {});

} // namespace plisse
