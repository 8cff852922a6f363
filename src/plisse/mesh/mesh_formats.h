#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <plisse/mesh/read_mesh.h>

namespace plisse {

/// read_mesh on bytes in memory; the path tells the format and stands in messages.
MeshFile parse_mesh(std::string_view bytes, const std::filesystem::path& path);

/// Readers of one format each: `bytes` is the whole file, `file` its name for messages. They refuse what is malformed;
/// parse_mesh refuses what is empty.
MeshFile read_obj(std::string_view bytes, const std::string& file);
MeshFile read_off(std::string_view bytes, const std::string& file);
MeshFile read_ply(std::string_view bytes, const std::string& file);
MeshFile read_stl(std::string_view bytes, const std::string& file);

/// Points as the columns of a matrix.
Positions to_positions(const std::vector<Vec3>& points);

} // namespace plisse
