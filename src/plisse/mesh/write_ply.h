#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// Writes a binary little-endian PLY with double positions, atomically (a killed writer leaves the old file or none).
/// face_body, when not empty, becomes the int face property "body". Attributes of the mesh are written as properties:
/// numbers alone, several as a list; "uv" of vertices as s and t, of corners as the face's list "texcoord", other
/// corner attributes as the list "corner_NAME". Their names hold no white space. read_mesh reads all of it back to the
/// bit. Throws std::runtime_error when the file cannot be written.
void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, std::span<const int> face_body = {});

} // namespace plisse
