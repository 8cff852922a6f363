#pragma once

#include <plisse/scene/scene.h>

namespace plisse {

/// Reads a scene file: JSON with comments; keys that begin with "x-" are the user's own. Throws InputError with file,
/// line, column and JSON pointer for anything that is not understood, out of range, or for a later version.
Scene read_scene(const std::filesystem::path& path);

/// The same from text. file: as messages name it; folder: where relative mesh files are looked for.
Scene parse_scene(const std::string& file, std::string_view text, const std::filesystem::path& folder);

} // namespace plisse
