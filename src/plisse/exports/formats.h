#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <plisse/exports/animation.h>

namespace plisse {

enum class AnimationFormat { usd, gltf, pvd, pc2, obj, ply };

/// By its name on the command line; nothing for an unknown one.
std::optional<AnimationFormat> animation_format(const std::string& name);

/// What an export to the path makes, files and folders, the path itself first. OBJ and PLY make a file where the path
/// ends in .obj or .ply, which takes a single state, and else a folder. Throws InputError when the path's extension is
/// not the format's.
std::vector<std::filesystem::path> exported_files(AnimationFormat format, const std::filesystem::path& path);

/// Writes the animation, replacing what exported_files lists; nothing half-written is left behind. Throws as the
/// writers of the formats do, and as exported_files does.
void write_animation(AnimationFormat format, const std::filesystem::path& path, const Animation& animation);

} // namespace plisse
