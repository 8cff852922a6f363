#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse bench NAME`: progressive and direct runs of one scene, side by side.
void add_bench_command(CLI::App& app);

} // namespace plisse
