#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace plisse::house {

/// What is wrong with the includes of one file of src/plisse/FOLDER, one sentence each: an include of a folder that
/// FOLDER must not see, or one not written as <plisse/folder/file.h>.
std::vector<std::string> wrong_includes(const std::string& folder, std::string_view text);

/// Is it a folder of src/plisse that the order of folders names?
bool is_known_folder(const std::string& folder);

} // namespace plisse::house
