#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse bench NAME`: methods side by side on built-in scenes.
void add_bench_command(CLI::App& app);

} // namespace plisse
