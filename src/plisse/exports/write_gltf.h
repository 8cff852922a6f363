#pragma once

#include <filesystem>

#include <plisse/exports/animation.h>

namespace plisse {

/// Writes glTF 2.0: as one binary file where the path ends in .glb, else as JSON with its buffer beside it in a .bin. A
/// mesh a part; each state after the first is a morph target, and weights that are 1 at its time and 0 at all others
/// play them. Parts that never move have none. Positions are single precision; normals and texture coordinates are
/// included. Replaces the files. Throws InputError when there are more states or bytes than readers can take, and
/// std::runtime_error when the files cannot be written.
void write_gltf(const std::filesystem::path& path, const Animation& animation);

/// The buffer beside a .gltf.
std::filesystem::path gltf_buffer_file(const std::filesystem::path& path);

} // namespace plisse
