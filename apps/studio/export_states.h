#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <plisse/exports/formats.h>
#include <plisse/model/discretization.h>

#include "board.h"

namespace plisse::studio {

/// Writes states of one level, in order of time, to FOLDER/NAME.* for another program: a file, or where the format
/// makes several a .tar of them. Returns the file's name. Throws what the writers of the format do.
std::string export_states(const std::filesystem::path& folder, const std::string& name, AnimationFormat format,
                          const Discretization& discretization, const std::vector<Board::SavedFrame>& states);

} // namespace plisse::studio
