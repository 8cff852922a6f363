#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse hierarchy`: decimates a mesh into nested levels with the map between them.
void add_hierarchy_command(CLI::App& app);

} // namespace plisse
