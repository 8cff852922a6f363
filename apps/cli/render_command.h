#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse render`: a picture of a mesh or of a run, without any display.
void add_render_command(CLI::App& app);

} // namespace plisse
