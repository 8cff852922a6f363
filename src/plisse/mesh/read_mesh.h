#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// A mesh file as read: vertex order and attributes kept, larger faces fanned from their first corner.
struct MeshFile {
    TriangleMesh mesh;
    std::vector<std::string> notes; ///< what was changed on the way, one sentence each
};

/// Reads OBJ, PLY (text or binary), STL (text or binary) or OFF, by extension. STL alone merges bit-identical corners.
/// Texture coordinates become the attribute "uv" (of OBJ at corners, unless their indices are those of the vertices);
/// other PLY properties and OBJ colours are attributes under their own names. Normals of OBJ, OFF and STL are not kept.
/// Throws InputError that names the file, and the line where the format has lines, for a file that is missing, empty,
/// truncated or malformed, for indices out of range and for coordinates that are not finite.
MeshFile read_mesh(const std::filesystem::path& path);

} // namespace plisse
