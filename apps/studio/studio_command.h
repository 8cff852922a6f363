#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse studio [SCENE]`: serves the page until it is interrupted.
void add_studio_command(CLI::App& app);

} // namespace plisse
