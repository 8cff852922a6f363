#pragma once

#include "rmtr_results.h"

namespace plisse {

/// Prints what has been measured beside what the paper has, which stands in brackets; a dash where the paper reports
/// failure.
void print_rmtr_tables(const RmtrResults& results, const ContestRules& rules);

} // namespace plisse
