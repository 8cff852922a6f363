#pragma once

#include <filesystem>

#include <plisse/exports/animation.h>

namespace plisse {

/// Writes a PC2 point cache, a sample for each state at frames 0, 1, ..., and beside it the mesh to put it on: the
/// first state as an OBJ of the same name, its vertices in the cache's order. Vertices of no face are left out of both:
/// Blender leaves them out when it reads an OBJ, and plays no cache of another size. Positions of the cache are single
/// precision. Replaces both files. Throws std::runtime_error when they cannot be written.
void write_pc2(const std::filesystem::path& path, const Animation& animation);

/// The OBJ beside a cache.
std::filesystem::path pc2_mesh_file(const std::filesystem::path& path);

} // namespace plisse
