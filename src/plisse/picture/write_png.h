#pragma once

#include <filesystem>

#include <plisse/picture/image.h>

namespace plisse {

/// Writes an 8-bit sRGB PNG, atomically: a killed writer leaves the old file or none. Throws std::runtime_error when
/// the file cannot be written.
void write_png(const std::filesystem::path& path, const Image& image);

} // namespace plisse
