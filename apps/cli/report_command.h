#pragma once

#include <CLI/CLI.hpp>

namespace plisse {

/// `plisse report`: tables of a run, two runs compared, or a page.
void add_report_command(CLI::App& app);

} // namespace plisse
