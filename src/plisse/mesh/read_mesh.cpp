#include <plisse/mesh/read_mesh.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include <plisse/base/error.h>
#include <plisse/mesh/mesh_formats.h>
#include <plisse/mesh/text_lines.h>

namespace plisse {

namespace {

constexpr const char* formats = "OBJ, PLY, STL or OFF";

std::string lower_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return extension;
}

} // namespace

std::string read_mesh_bytes(const std::filesystem::path& path, const std::string& remedy) {
    const std::string file = path.string();
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status))
        throw InputError(file, "no such file", remedy);
    if (std::filesystem::is_directory(status))
        throw InputError(file, "is a folder", remedy);
    std::ifstream stream(path, std::ios::binary);
    std::string bytes;
    const auto size = std::filesystem::is_regular_file(status) ? std::filesystem::file_size(path, error) : 0;
    // Every element takes at least a byte, so below this size all counts and numbers of corners fit an int.
    if (size > static_cast<std::uintmax_t>(std::numeric_limits<int>::max()))
        throw InputError(file, "is larger than 2 GiB", "cut the mesh into smaller files or use binary PLY");
    bytes.resize(static_cast<std::size_t>(size));
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!stream || static_cast<std::uintmax_t>(stream.gcount()) != size)
        throw InputError(file, "cannot be read", "check the permissions of the file");
    return bytes;
}

Positions to_positions(const std::vector<Vec3>& points) {
    Positions positions(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        positions.col(static_cast<Eigen::Index>(i)) = points[i];
    return positions;
}

MeshFile parse_mesh(std::string_view bytes, const std::filesystem::path& path) {
    const std::string file = path.string();
    const std::string extension = lower_extension(path);
    if (bytes.empty())
        throw InputError(file, "is empty", std::string("give a mesh file in ") + formats);
    MeshFile result;
    if (extension == ".obj")
        result = read_obj(bytes, file);
    else if (extension == ".ply")
        result = read_ply(bytes, file);
    else if (extension == ".stl")
        result = read_stl(bytes, file);
    else if (extension == ".off")
        result = read_off(bytes, file);
    else
        throw InputError(file, "has the unknown extension " + in_quotes(extension),
                         "use a mesh file in OBJ, PLY, STL or OFF with its usual extension");
    if (result.mesh.vertex_count() == 0)
        throw InputError(file, "has no vertices", "give a mesh with at least one triangle");
    if (result.mesh.face_count() == 0)
        throw InputError(file, "has no faces", "give a mesh with at least one triangle");
    return result;
}

MeshFile read_mesh(const std::filesystem::path& path) {
    return parse_mesh(read_mesh_bytes(path, std::string("give the path of a mesh file in ") + formats), path);
}

} // namespace plisse
