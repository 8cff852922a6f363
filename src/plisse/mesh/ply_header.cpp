#include <plisse/mesh/ply_header.h>

#include <algorithm>
#include <array>
#include <utility>

#include <plisse/base/error.h>
#include <plisse/mesh/text_lines.h>

namespace plisse {

namespace {

/// Both sets of names in use.
constexpr std::array<std::pair<std::string_view, PlyType>, 16> type_names = {{{"char", PlyType::int8},
                                                                              {"int8", PlyType::int8},
                                                                              {"uchar", PlyType::uint8},
                                                                              {"uint8", PlyType::uint8},
                                                                              {"short", PlyType::int16},
                                                                              {"int16", PlyType::int16},
                                                                              {"ushort", PlyType::uint16},
                                                                              {"uint16", PlyType::uint16},
                                                                              {"int", PlyType::int32},
                                                                              {"int32", PlyType::int32},
                                                                              {"uint", PlyType::uint32},
                                                                              {"uint32", PlyType::uint32},
                                                                              {"float", PlyType::float32},
                                                                              {"float32", PlyType::float32},
                                                                              {"double", PlyType::float64},
                                                                              {"float64", PlyType::float64}}};

PlyType parse_type(const TextLines& lines, std::string_view word) {
    for (const auto& [name, type] : type_names)
        if (word == name)
            return type;
    lines.fail(in_quotes(word) + " is no type", "use char, uchar, short, ushort, int, uint, float or double");
}

void parse_format(const TextLines& lines, PlyHeader& header) {
    const auto words = lines.words();
    const bool version_one = words.size() == 3 && words[2] == "1.0";
    header.is_text = version_one && words[1] == "ascii";
    const bool little = version_one && words[1] == "binary_little_endian";
    const bool big = version_one && words[1] == "binary_big_endian";
    if (!header.is_text && !little && !big)
        lines.fail("an unknown format", "write format ascii 1.0, binary_little_endian 1.0 or binary_big_endian 1.0");
    header.byte_order = big ? std::endian::big : std::endian::little;
}

void parse_element(const TextLines& lines, PlyHeader& header) {
    const auto words = lines.words();
    if (words.size() != 3)
        lines.fail("an element of " + std::to_string(words.size()) + " words", "write element NAME COUNT");
    const long long count = lines.integer(2, "the count of elements");
    if (count < 0)
        lines.fail("a negative count", "write the number of elements");
    const std::string name(words[1]);
    for (const PlyElement& other : header.elements)
        if (other.name == name)
            lines.fail("a second element " + in_quotes(name), "name each element once");
    header.elements.push_back({name, static_cast<std::size_t>(count), {}});
}

void parse_property(const TextLines& lines, PlyHeader& header) {
    // Bounds what a face that is cut into many triangles can cost.
    constexpr std::size_t most_properties = 256;
    const auto words = lines.words();
    if (header.elements.empty())
        lines.fail("a property before any element", "write element NAME COUNT first");
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3)
        lines.fail("a malformed property", "write property TYPE NAME, or property list TYPE TYPE NAME");
    PlyProperty property;
    property.is_list = is_list;
    property.name = std::string(words.back());
    property.type = parse_type(lines, words[words.size() - 2]);
    if (is_list)
        property.count_type = parse_type(lines, words[2]);
    if (is_list && !is_integer(property.count_type))
        lines.fail("a list whose count is no integer", "use uchar, ushort, int or uint for the count");
    PlyElement& element = header.elements.back();
    for (const PlyProperty& other : element.properties)
        if (other.name == property.name)
            lines.fail("a second property " + in_quotes(property.name), "name each property of an element once");
    if (element.properties.size() == most_properties)
        lines.fail("more than 256 properties of one element", "leave out what is not needed");
    element.properties.push_back(std::move(property));
}

} // namespace

std::size_t size_of(PlyType type) {
    constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

PlyHeader read_ply_header(std::string_view bytes, const std::string& file) {
    TextLines lines(bytes, file, 0);
    PlyHeader header;
    if (!lines.next() || lines.words()[0] != "ply")
        throw InputError(file + ":1", "does not begin with the word ply", "give a PLY file");
    bool has_format = false;
    while (lines.next()) {
        const std::string_view word = lines.words()[0];
        if (word == "format") {
            parse_format(lines, header);
            has_format = true;
        } else if (word == "element") {
            parse_element(lines, header);
        } else if (word == "property") {
            parse_property(lines, header);
        } else if (word == "end_header") {
            if (!has_format)
                lines.fail("a header without a format", "write format ascii 1.0 or another format");
            header.body = lines.position();
            header.lines = lines.line();
            return header;
        } else if (word != "comment" && word != "obj_info") {
            lines.fail(in_quotes(word) + " is no part of a header",
                       "write format, element, property, comment or end_header");
        }
    }
    throw InputError(file, "ends before end_header", "is the file complete?");
}

} // namespace plisse
