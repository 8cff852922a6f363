#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse studio` of a program that was built without it: says so.
void add_missing_studio_command(CLI::App& app);

} // namespace plisse
