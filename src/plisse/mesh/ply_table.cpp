#include <plisse/mesh/ply_table.h>

#include <array>
#include <cmath>

#include <plisse/base/error.h>
#include <plisse/mesh/binary_bytes.h>
#include <plisse/mesh/text_lines.h>

namespace plisse {

namespace {

class TextSource {
public:
    TextSource(std::string_view bytes, const PlyHeader& header, const std::string& file)
        : lines_(bytes.substr(header.body), file, 0, TextLines::Continuation::none, header.lines), file_(file) {}

    /// Fewest bytes an element can take: a digit and a separator for each property.
    static std::size_t smallest(const PlyElement& element) { return 2 * element.properties.size(); }
    std::size_t remaining() const { return lines_.remaining() + 1; }

    void begin_element(const PlyElement& element, std::size_t row) {
        if (!lines_.next())
            throw InputError(file_,
                             "ends before " + element.name + " " + std::to_string(row) + " of " +
                                 std::to_string(element.count),
                             "is the file complete?");
        word_ = 0;
    }

    double take(PlyType type, const PlyProperty& property) {
        const double value = lines_.number(word_++, property.name.c_str());
        if (is_integer(type) && !fits(type, value))
            lines_.fail(in_quotes(lines_.words()[word_ - 1]) + " is out of the range of the integer " +
                            in_quotes(property.name),
                        "write a whole number that its type can hold");
        return value;
    }

    std::string place() const { return lines_.place(); }
    bool more_follows() { return lines_.next(); }
    std::size_t room(PlyType) const { return lines_.words().size() - word_; }

    void end_element(PlyTable& table) {
        if (word_ < lines_.words().size())
            lines_.fail("more numbers than the header announces", "write one " + table.element->name + " a line");
        table.lines.push_back(lines_.line());
    }

private:
    static bool fits(PlyType type, double value) {
        static constexpr std::array<std::array<double, 2>, 6> range = {
            {{-128, 127}, {0, 255}, {-32768, 32767}, {0, 65535}, {-2147483648.0, 2147483647.0}, {0, 4294967295.0}}};
        const auto& [low, high] = range[static_cast<std::size_t>(type)];
        return value >= low && value <= high && value == std::floor(value);
    }

    TextLines lines_;
    std::string file_;
    std::size_t word_ = 0;
};

class BinarySource {
public:
    BinarySource(std::string_view bytes, const PlyHeader& header, const std::string& file)
        : data_(bytes.substr(header.body), header.byte_order), file_(file) {}

    /// Fewest bytes an element can take: its lists all empty.
    static std::size_t smallest(const PlyElement& element) {
        std::size_t size = 0;
        for (const PlyProperty& property : element.properties)
            size += size_of(property.is_list ? property.count_type : property.type);
        return size;
    }
    std::size_t remaining() const { return data_.remaining(); }

    void begin_element(const PlyElement& element, std::size_t row) {
        element_ = &element;
        row_ = row;
    }

    double take(PlyType type, const PlyProperty&) {
        if (data_.remaining() < size_of(type))
            throw InputError(file_,
                             "ends within " + element_->name + " " + std::to_string(row_) + " of " +
                                 std::to_string(element_->count),
                             "is the file complete?");
        switch (type) {
        case PlyType::int8:
            return data_.take<std::int8_t>();
        case PlyType::uint8:
            return data_.take<std::uint8_t>();
        case PlyType::int16:
            return data_.take<std::int16_t>();
        case PlyType::uint16:
            return data_.take<std::uint16_t>();
        case PlyType::int32:
            return data_.take<std::int32_t>();
        case PlyType::uint32:
            return data_.take<std::uint32_t>();
        case PlyType::float32:
            return data_.take<float>();
        case PlyType::float64:
            break;
        }
        return data_.take<double>();
    }

    std::string place() const { return file_; }
    bool more_follows() const { return data_.remaining() > 0; }
    std::size_t room(PlyType type) const { return data_.remaining() / size_of(type); }
    void end_element(PlyTable&) {}

private:
    BinaryBytes data_;
    std::string file_;
    const PlyElement* element_ = nullptr;
    std::size_t row_ = 0;
};

template <typename Source>
void read_list(Source& source, const PlyProperty& property, PlyTable& table, PlyColumn& column, std::size_t row) {
    const double size = source.take(property.count_type, property);
    if (size < 0 || size > static_cast<double>(source.room(property.type)))
        throw InputError(source.place(),
                         table.element->name + " " + std::to_string(row) + " has a list " + in_quotes(property.name) +
                             " of " + std::to_string(static_cast<long long>(size)) +
                             " entries, more than the file holds there",
                         "is the file complete?");
    column.sizes.push_back(static_cast<std::uint32_t>(size));
    for (double k = 0; k < size; ++k)
        column.values.push_back(source.take(property.type, property));
}

template <typename Source>
PlyTable read_table(Source& source, const PlyElement& element, const std::string& file) {
    PlyTable table{&element, std::vector<PlyColumn>(element.properties.size()), {}, file};
    const std::size_t smallest = Source::smallest(element);
    if (smallest == 0)
        return table; // elements without properties take no bytes
    if (element.count > source.remaining() / smallest)
        throw InputError(file,
                         "announces " + std::to_string(element.count) + " elements " + in_quotes(element.name) +
                             " and is too short to hold them",
                         "is the file complete?");
    for (std::size_t row = 0; row < element.count; ++row) {
        source.begin_element(element, row);
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const PlyProperty& property = element.properties[p];
            if (property.is_list)
                read_list(source, property, table, table.columns[p], row);
            else
                table.columns[p].values.push_back(source.take(property.type, property));
        }
        source.end_element(table);
    }
    return table;
}

template <typename Source>
PlyBody read_tables(std::string_view bytes, const PlyHeader& header, const std::string& file) {
    Source source(bytes, header, file);
    PlyBody body;
    for (const PlyElement& element : header.elements)
        body.tables.push_back(read_table(source, element, file));
    body.more_follows = source.more_follows();
    return body;
}

} // namespace

int PlyTable::find(std::string_view name) const {
    for (std::size_t p = 0; p < element->properties.size(); ++p)
        if (element->properties[p].name == name)
            return static_cast<int>(p);
    return -1;
}

PlyBody read_ply_body(std::string_view bytes, const PlyHeader& header, const std::string& file) {
    return header.is_text ? read_tables<TextSource>(bytes, header, file)
                          : read_tables<BinarySource>(bytes, header, file);
}

} // namespace plisse
