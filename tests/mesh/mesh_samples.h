#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include <plisse/base/error.h>
#include <plisse/mesh/read_mesh.h>

namespace plisse {

/// A folder of its own for one test, gone afterwards.
class TemporaryFolder {
public:
    TemporaryFolder() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        std::string name = std::string(test->test_suite_name()) + "-" + test->name() + "-" + std::to_string(::getpid());
        std::replace(name.begin(), name.end(), '/', '-');
        path_ = std::filesystem::temp_directory_path() / ("plisse-" + name);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path_ / name, std::ios::binary) << bytes;
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

/// The message of the InputError that reading the file ends in; empty when it does not.
inline std::string refusal(const std::filesystem::path& path) {
    try {
        read_mesh(path);
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

template <typename T>
std::string raw_bytes(T value, bool big_endian = false) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big_endian)
        std::reverse(bytes, bytes + sizeof(T));
    return std::string(bytes, sizeof(T));
}

/// A tetrahedron in each format, with what else the format can carry.
inline std::string tetrahedron_obj() {
    return "# tetrahedron\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0.5 1\n"
           "f 1/1 3/2 2/3\nf 1/1 2/2 4/3\nf 1/1 4/2 3/3\nf 2/1 3/2 4/3\n";
}

inline std::string tetrahedron_off() {
    return "OFF # tetrahedron\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n\n3 0 2 1\n3 0 1 3 255 0 0\n3 0 3 2\n3 1 2 3\n";
}

inline std::string tetrahedron_ply_text() {
    return "ply\nformat ascii 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty float x\nproperty float y\n"
           "property float z\nproperty uchar red\nelement face 4\nproperty list uchar int vertex_indices\n"
           "property short group\nelement edge 1\nproperty int first\nproperty list int float weights\nend_header\n"
           "0 0 0 10\n1 0 0 20\n0 1 0 30\n0 0 1 40\n3 0 2 1 7\n3 0 1 3 8\n3 0 3 2 9\n3 1 2 3 -1\n5 2 0.5 0.25\n";
}

inline std::string tetrahedron_ply_binary(bool big_endian) {
    std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                        "_endian 1.0\nelement thing 1\nproperty list ushort double values\nelement vertex 4\n"
                        "property double x\nproperty char tag\nproperty float y\nproperty double z\n"
                        "element face 4\nproperty list int ushort vertex_index\nproperty list uchar float texcoord\n"
                        "end_header\n";
    bytes += raw_bytes(std::uint16_t{2}, big_endian) + raw_bytes(1.5, big_endian) + raw_bytes(2.5, big_endian);
    const double points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const auto& p : points)
        bytes += raw_bytes(p[0], big_endian) + raw_bytes(std::int8_t{-3}) +
                 raw_bytes(static_cast<float>(p[1]), big_endian) + raw_bytes(p[2], big_endian);
    const std::uint16_t faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    for (const auto& face : faces) {
        bytes += raw_bytes(std::int32_t{3}, big_endian);
        for (std::uint16_t v : face)
            bytes += raw_bytes(v, big_endian);
        bytes += raw_bytes(std::uint8_t{6});
        for (int k = 0; k < 6; ++k)
            bytes += raw_bytes(static_cast<float>(k) / 4, big_endian);
    }
    return bytes;
}

inline const double (&tetrahedron_corners())[4][3][3] {
    static const double corners[4][3][3] = {{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                                            {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                                            {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                            {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return corners;
}

inline std::string tetrahedron_stl_text() {
    std::string text = "solid tetrahedron\n";
    for (const auto& face : tetrahedron_corners()) {
        text += "facet normal 0 0 0\n outer loop\n";
        for (const auto& p : face)
            text += "  vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
        text += " endloop\nendfacet\n";
    }
    return text + "endsolid tetrahedron\n";
}

inline std::string tetrahedron_stl_binary() {
    std::string bytes = "solid, though binary";
    bytes.resize(80, ' ');
    bytes += raw_bytes(std::uint32_t{4});
    for (const auto& face : tetrahedron_corners()) {
        bytes += std::string(12, '\0');
        for (const auto& p : face)
            for (double value : p)
                bytes += raw_bytes(static_cast<float>(value));
        bytes += std::string(2, '\0');
    }
    return bytes;
}

} // namespace plisse
