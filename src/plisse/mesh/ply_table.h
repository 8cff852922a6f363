#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <plisse/mesh/ply_header.h>

namespace plisse {

/// One property of all elements of a kind. A double holds every PLY number exactly.
struct PlyColumn {
    std::vector<double> values;       ///< one an element; of a list, all its lists one after the other
    std::vector<std::uint32_t> sizes; ///< of a list: its length for each element
};

/// All elements of a kind: a column for each property of the header.
struct PlyTable {
    const PlyElement* element = nullptr;
    std::vector<PlyColumn> columns;
    std::vector<int> lines; ///< of each element, in a text file
    std::string file;

    std::size_t count() const { return element->count; }
    /// Where element number `row` stands, for messages.
    std::string place(std::size_t row) const { return lines.empty() ? file : file + ":" + std::to_string(lines[row]); }
    /// Number of the property of that name, -1 when there is none.
    int find(std::string_view name) const;
};

struct PlyBody {
    std::vector<PlyTable> tables; ///< one for each element of the header
    bool more_follows = false;    ///< bytes or lines after the last element
};

/// Reads what follows the header. Throws InputError for a body that is too short for the counts of the header, before
/// memory is taken for it, and for malformed numbers.
PlyBody read_ply_body(std::string_view bytes, const PlyHeader& header, const std::string& file);

} // namespace plisse
