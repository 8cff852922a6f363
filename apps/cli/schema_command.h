#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse schema`: prints the JSON Schema of scene files.
void add_schema_command(CLI::App& app);

} // namespace plisse
