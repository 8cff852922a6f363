#pragma once

#include <cstdint>

#include <nlohmann/json_fwd.hpp>

#include <plisse/drive/recorder.h>

namespace plisse {

/// What report.json says of the process that wrote it.
struct ProcessFacts {
    std::string version;
    int threads = 1;
    std::uint64_t peak_memory_bytes = 0;
};

/// The largest memory this process has had resident so far, bytes.
std::uint64_t peak_memory_bytes();

/// The contents of report.json. Infinities become null.
nlohmann::ordered_json report_to_json(const RunReport& report, const ProcessFacts& process);

/// The report again, to the bit. Throws nlohmann::json::exception when the object is not a report's.
RunReport report_from_json(const nlohmann::ordered_json& json);

} // namespace plisse
