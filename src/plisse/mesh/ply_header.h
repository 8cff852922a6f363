#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <vector>

namespace plisse {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);
inline bool is_integer(PlyType type) {
    return type < PlyType::float32;
}

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8; ///< of a list
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    bool is_text = false;
    std::endian byte_order = std::endian::little;
    std::vector<PlyElement> elements;
    std::size_t body = 0; ///< offset of the first byte after the header
    int lines = 0;        ///< of the header
};

/// Throws InputError for anything that is not the header of a PLY 1.0 file. Counts are as the file says.
PlyHeader read_ply_header(std::string_view bytes, const std::string& file);

} // namespace plisse
