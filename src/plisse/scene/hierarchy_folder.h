#pragma once

#include <filesystem>

#include <plisse/decimate/hierarchy_bytes.h>
#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// A hierarchy's meshes and map on disk, as `plisse hierarchy` writes them and `plisse prolong` reads them:
///   level-0.ply (coarsest) ... level-(N-1).ply (the input's own vertices, in its order), attributes on every level
///   map.json  {"format": 1, "levels": N, "to_finest": [MAP, ...], "to_next": [MAP, ...]}, lists by level, where MAP is
///             {"faces": [...], "weights": [[a, b, c], ...]}: per finer vertex the face of the level it is anchored in
///             (-1 for a vertex no face uses) and barycentric weights. The finest level's entries are left out.
///   hierarchy.bin  the whole hierarchy with its collapses, which affine prolongation needs; for this machine
struct HierarchyFiles {
    std::vector<TriangleMesh> levels;
    std::vector<std::vector<Anchor>> to_finest, to_next; ///< one list a level but the finest
};

/// attributes: of the finest mesh. Throws std::runtime_error when a file cannot be written.
void write_hierarchy(const std::filesystem::path& folder, const DecimationResult& decimation,
                     const std::vector<MeshAttribute>& attributes);

/// Throws InputError when the folder holds no hierarchy or its parts do not fit each other.
HierarchyFiles read_hierarchy(const std::filesystem::path& folder);

/// The hierarchy with its collapses. Throws InputError when it is missing or damaged.
Hierarchy read_collapses(const std::filesystem::path& folder);

} // namespace plisse
