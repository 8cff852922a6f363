#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <plisse/decimate/decimate.h>

namespace plisse {

/// What one decimation gave.
struct DecimationResult {
    Hierarchy hierarchy;
    DecimationSummary summary;
};

/// Names an input together with its options: 32 hexadecimal digits that are the same for the same bits.
std::string fingerprint(const DecimationInput& input, const DecimationOptions& options);

/// The result as bytes for a file on this machine, with a checksum.
std::string to_bytes(const DecimationResult& result);

/// The result exactly as it was; nothing when the bytes are damaged or incomplete.
std::optional<DecimationResult> from_bytes(std::string_view bytes);

} // namespace plisse
