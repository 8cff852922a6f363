#pragma once

#include <filesystem>
#include <span>
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

/// The polygons of an OBJ file, as they stand there.
struct ObjPolygons {
    std::vector<Vec3> points;
    std::vector<int> corners;   ///< of all polygons in turn, vertex numbers from 0
    std::vector<int> starts{0}; ///< polygon p has corners starts[p] <= c < starts[p + 1]
    std::vector<int> lines;     ///< per polygon: where it stands in the file

    std::span<const int> polygon(std::size_t p) const {
        const auto first = static_cast<std::size_t>(starts[p]);
        return std::span(corners).subspan(first, static_cast<std::size_t>(starts[p + 1]) - first);
    }
};
ObjPolygons read_obj_polygons(std::string_view bytes, const std::string& file);

/// The whole file. Throws InputError when it cannot be read, with `remedy`.
std::string read_mesh_bytes(const std::filesystem::path& path, const std::string& remedy);

/// Points as the columns of a matrix.
Positions to_positions(const std::vector<Vec3>& points);

} // namespace plisse
