#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse run`: runs a scene into an output folder.
void add_run_command(CLI::App& app);

} // namespace plisse
