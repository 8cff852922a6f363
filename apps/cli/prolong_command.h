#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse prolong`: carries deformed coarse positions to the finest mesh of a hierarchy.
void add_prolong_command(CLI::App& app);

} // namespace plisse
