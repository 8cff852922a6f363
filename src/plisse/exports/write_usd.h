#pragma once

#include <filesystem>

#include <plisse/exports/animation.h>

namespace plisse {

/// Writes a USD stage as text: one Mesh prim a part with time-sampled points (of parts that never move, one value),
/// metres, +y up, a time code for each frame. Positions are single precision. Texture coordinates become primvars:st.
/// Replaces the file. Throws std::runtime_error when it cannot be written.
void write_usd(const std::filesystem::path& path, const Animation& animation);

} // namespace plisse
