#pragma once

#include <string>
#include <vector>

#include "report_table.h"

namespace plisse {

/// One iteration of DIR/log.jsonl, as the page's chart needs it.
struct LoggedIteration {
    int level = 0;
    double step_norm = 0; ///< m/s
};

/// Reads DIR/log.jsonl; empty when there is none.
std::vector<LoggedIteration> read_log(const std::filesystem::path& run_folder);

/// A page that stands alone: the run's tables, seconds by phase as bars, and the Newton step norm over iterations.
std::string report_page(const StoredReport& stored, const std::vector<LoggedIteration>& log);

} // namespace plisse
