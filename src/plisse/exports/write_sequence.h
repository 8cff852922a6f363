#pragma once

#include <filesystem>

#include <plisse/exports/animation.h>

namespace plisse {

/// Writes a folder of one file a state, NAME.0001.obj or NAME.0001.ply where NAME is the folder's, with all attributes
/// that the format can hold. Replaces a folder that holds such files only. Throws InputError for one that holds others,
/// and std::runtime_error when it cannot be written.
void write_obj_sequence(const std::filesystem::path& folder, const Animation& animation);
void write_ply_sequence(const std::filesystem::path& folder, const Animation& animation);

} // namespace plisse
