#include <plisse/scene/json_lines.h>

#include <algorithm>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace plisse {

JsonLines::JsonLines(std::filesystem::path path, std::uintmax_t keep_bytes) : path_(std::move(path)) {
    if (std::filesystem::exists(path_)) {
        bytes_ = std::min(keep_bytes, std::filesystem::file_size(path_));
        std::filesystem::resize_file(path_, bytes_);
    }
    out_.open(path_, std::ios::binary | std::ios::app);
    expect_good();
}

void JsonLines::append(const nlohmann::ordered_json& object) {
    const std::string line = object.dump() + "\n";
    out_ << line;
    bytes_ += line.size();
    expect_good();
}

std::uintmax_t JsonLines::flush() {
    out_.flush();
    expect_good();
    return bytes_;
}

void JsonLines::expect_good() const {
    if (!out_)
        throw std::runtime_error(path_.string() + ": the file cannot be written; see that the disk is not full");
}

} // namespace plisse
