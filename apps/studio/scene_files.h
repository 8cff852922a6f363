#pragma once

#include <filesystem>
#include <set>
#include <string>

#include <plisse/scene/scene.h>

namespace plisse::studio {

/// The files that a scene names: meshes and its edit log.
std::set<std::string> files_of(const Scene& scene);

/// Throws InputError when a page's scene names a file that is not one of `known` and does not lie in the session's
/// folder: a page may not have other files of this machine read.
void expect_no_other_files(const Scene& scene, const std::set<std::string>& known,
                           const std::filesystem::path& session_folder);

} // namespace plisse::studio
