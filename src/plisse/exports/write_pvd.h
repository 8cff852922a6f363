#pragma once

#include <filesystem>

#include <plisse/exports/animation.h>

namespace plisse {

/// Writes a ParaView collection NAME.pvd and beside it the folder NAME with a file NAME.0001.vtp for each state, with
/// all attributes of vertices and faces. Replaces the file, and a folder that holds such files only. Throws InputError
/// for a folder that holds others, and std::runtime_error when they cannot be written.
void write_pvd(const std::filesystem::path& path, const Animation& animation);

/// The folder beside a collection.
std::filesystem::path pvd_folder(const std::filesystem::path& path);

} // namespace plisse
