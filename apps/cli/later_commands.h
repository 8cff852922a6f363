#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// Subcommands whose names are fixed but which this version answers with "not supported".
void add_later_commands(CLI::App& app);

} // namespace plisse
