#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse export`: writes a run's animation for other programs.
void add_export_command(CLI::App& app);

} // namespace plisse
