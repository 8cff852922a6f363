#pragma once

#include <filesystem>
#include <string>

#include <plisse/scene/report_json.h>

namespace plisse {

/// A run's report with what it says of its process.
struct StoredReport {
    RunReport report;
    ProcessFacts process;
};

/// Reads DIR/report.json. Throws InputError when there is none or it is not one.
StoredReport read_report(const std::filesystem::path& run_folder);

/// Tables for people: the run in one line, seconds per level and phase, iterations, gaps, refinements, what lags.
std::string report_table(const StoredReport& stored);

/// Two runs side by side with the ratio of their seconds and iterations, level by level.
std::string comparison_table(const StoredReport& a, const std::string& name_a, const StoredReport& b,
                             const std::string& name_b);

} // namespace plisse
