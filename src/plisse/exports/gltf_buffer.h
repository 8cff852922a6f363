#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include <plisse/base/types.h>
#include <plisse/exports/unfinished_files.h>

namespace plisse {

/// The one binary buffer of a glTF asset, written to a file as it grows, with the accessors and buffer views that refer
/// to it. Each array added gets an accessor, whose number is returned.
class GltfBuffer {
public:
    explicit GltfBuffer(const std::filesystem::path& path) : file_(path) {}

    int add_positions(const Eigen::Matrix3Xf& points); ///< with their bounds, as positions must have them
    int add_vectors(const Eigen::Matrix3Xf& vectors);
    int add_texture_points(std::span<const Vec2> points); ///< v turned to run downward, as it does in glTF
    int add_corners(std::span<const Face> faces);
    int add_times(std::span<const float> times);
    int add_scalars(std::span<const float> values);

    /// Ends the file.
    void close() { file_.close(); }
    std::uint64_t size() const { return size_; }
    const nlohmann::ordered_json& accessors() const { return accessors_; }
    const nlohmann::ordered_json& views() const { return views_; }

private:
    int add(const std::string& bytes, const char* type, int component_type, std::size_t count, int target);

    OutputFile file_;
    std::uint64_t size_ = 0;
    nlohmann::ordered_json accessors_ = nlohmann::ordered_json::array(), views_ = nlohmann::ordered_json::array();
};

} // namespace plisse
