#pragma once

#include <filesystem>
#include <string>

namespace plisse {

/// NAME.0001.EXTENSION for state 0 and so on, as programs that play sequences expect; the extension has its dot.
std::string numbered_file(const std::string& name, std::size_t k, const std::string& extension);

/// Throws InputError when the folder exists and holds anything but such files: it is not ours to replace.
void expect_own_folder(const std::filesystem::path& folder, const std::string& name, const std::string& extension);

} // namespace plisse
