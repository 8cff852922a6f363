#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace plisse {

/// Replaces the file in one step: a killed writer leaves the old file or none. Throws std::runtime_error naming the
/// file when it cannot be written.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

/// FNV-1a, 64 bits, as 16 hexadecimal digits: tells files apart, guards against nothing.
std::string fnv1a64(std::string_view bytes);

} // namespace plisse
