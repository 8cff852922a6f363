#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#include <nlohmann/json_fwd.hpp>

namespace plisse {

/// A file that grows by one JSON object a line.
class JsonLines {
public:
    JsonLines() = default;
    /// Keeps the first keep_bytes bytes of the file and writes after them. Throws std::runtime_error when it cannot be
    /// written.
    JsonLines(std::filesystem::path path, std::uintmax_t keep_bytes);

    void append(const nlohmann::ordered_json& object);
    /// Hands everything to the system; returns the size of the file.
    std::uintmax_t flush();

private:
    void expect_good() const;

    std::filesystem::path path_;
    std::ofstream out_;
    std::uintmax_t bytes_ = 0;
};

} // namespace plisse
