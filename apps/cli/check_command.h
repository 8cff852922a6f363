#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse check`: says whether meshes are usable.
void add_check_command(CLI::App& app);

} // namespace plisse
