#pragma once

#include <filesystem>
#include <span>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// Writes VTK's XML PolyData with appended binary data: positions in double precision, attributes of vertices as point
/// data, those of faces as cell data, and face_part as the cell data "body". Corner attributes have no place in it.
/// Throws std::runtime_error when it cannot be written; what is there then is not whole.
void write_vtp(const std::filesystem::path& path, const TriangleMesh& mesh, std::span<const int> face_part,
               double time);

} // namespace plisse
