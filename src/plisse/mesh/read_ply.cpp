#include <plisse/mesh/mesh_formats.h>

#include <array>
#include <cmath>

#include <plisse/base/error.h>
#include <plisse/mesh/ply_table.h>
#include <plisse/mesh/polygons.h>
#include <plisse/mesh/text_lines.h>

namespace plisse {

namespace {

/// Pairs of vertex properties that mean texture coordinates.
constexpr std::array<std::array<const char*, 2>, 3> texture_names = {
    {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};

MeshAttribute::Number number_of(PlyType type) {
    switch (type) {
    case PlyType::uint8:
        return MeshAttribute::Number::uint8;
    case PlyType::int8:
    case PlyType::int16:
    case PlyType::uint16:
    case PlyType::int32:
        return MeshAttribute::Number::int32;
    default:
        return MeshAttribute::Number::real;
    }
}

/// Length of every list of a column, or -1 when they differ.
int common_size(const PlyColumn& column) {
    for (std::uint32_t size : column.sizes)
        if (size != column.sizes.front())
            return -1;
    return column.sizes.empty() ? -1 : static_cast<int>(column.sizes.front());
}

class PlyReader {
public:
    PlyReader(std::string_view bytes, const std::string& file)
        : file_(file), header_(read_ply_header(bytes, file)), body_(read_ply_body(bytes, header_, file)) {}

    MeshFile read() {
        const PlyTable& vertices = table("vertex");
        const PlyTable& faces = table("face");
        read_positions(vertices);
        const std::size_t corners = read_faces(faces, vertices.count());
        add_vertex_attributes(vertices);
        add_face_attributes(faces, corners);
        polygons_.add_note(result_.notes);
        if (body_.more_follows)
            result_.notes.push_back("what follows the last element passed over");
        result_.mesh.faces = std::move(polygons_.faces());
        return std::move(result_);
    }

private:
    const PlyTable& table(const char* name) const {
        for (const PlyTable& candidate : body_.tables)
            if (candidate.element->name == name)
                return candidate;
        throw InputError(file_, std::string("has no element ") + name, "give a mesh with vertices and faces");
    }

    void read_positions(const PlyTable& vertices) {
        std::array<const PlyColumn*, 3> columns{};
        static constexpr const char* names[3] = {"x", "y", "z"};
        for (std::size_t k = 0; k < 3; ++k) {
            const int property = vertices.find(names[k]);
            if (property < 0 || vertices.element->properties[static_cast<std::size_t>(property)].is_list)
                throw InputError(file_, std::string("its vertices have no number ") + names[k],
                                 "declare property double x, y and z");
            columns[k] = &vertices.columns[static_cast<std::size_t>(property)];
        }
        result_.mesh.positions.resize(3, static_cast<Eigen::Index>(vertices.count()));
        for (std::size_t i = 0; i < vertices.count(); ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                const double value = columns[k]->values[i];
                if (!std::isfinite(value))
                    throw InputError(vertices.place(i),
                                     "vertex " + std::to_string(i) + " has a coordinate that is not finite",
                                     "write finite numbers");
                result_.mesh.positions(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = value;
            }
    }

    /// Returns the number of the property that lists the corners.
    std::size_t read_faces(const PlyTable& faces, std::size_t vertex_count) {
        const int plural = faces.find("vertex_indices");
        const int property = plural >= 0 ? plural : faces.find("vertex_index");
        const auto p = static_cast<std::size_t>(property);
        if (property < 0 || !faces.element->properties[p].is_list || !is_integer(faces.element->properties[p].type))
            throw InputError(file_, "its faces have no list vertex_indices of integers",
                             "declare property list uchar int vertex_indices");
        const PlyColumn& column = faces.columns[p];
        std::vector<int> corners;
        std::size_t next = 0;
        for (std::size_t f = 0; f < faces.count(); ++f) {
            if (column.sizes[f] < 3)
                throw InputError(faces.place(f),
                                 "face " + std::to_string(f) + " has " + std::to_string(column.sizes[f]) + " corners",
                                 "give at least three corners");
            corners.clear();
            for (std::uint32_t k = 0; k < column.sizes[f]; ++k) {
                const double index = column.values[next++];
                if (index < 0 || index >= static_cast<double>(vertex_count))
                    throw InputError(faces.place(f),
                                     "face " + std::to_string(f) + " refers to vertex " +
                                         std::to_string(static_cast<long long>(index)) + " of " +
                                         std::to_string(vertex_count),
                                     "count from 0 to the number of vertices less one");
                corners.push_back(static_cast<int>(index));
            }
            polygons_.add(corners);
        }
        return p;
    }

    void add_vertex_attributes(const PlyTable& vertices) {
        const auto& properties = vertices.element->properties;
        std::vector<bool> used(properties.size(), false);
        for (std::string_view name : {"x", "y", "z"})
            used[static_cast<std::size_t>(vertices.find(name))] = true;
        const auto [first, second] = texture_columns(vertices);
        for (std::size_t p = 0; p < properties.size(); ++p) {
            if (used[p])
                continue;
            if (static_cast<int>(p) == first || static_cast<int>(p) == second) {
                add_texture(vertices.columns[static_cast<std::size_t>(first)],
                            vertices.columns[static_cast<std::size_t>(second)]);
                used[static_cast<std::size_t>(first)] = used[static_cast<std::size_t>(second)] = true;
                continue;
            }
            const int width = properties[p].is_list ? common_size(vertices.columns[p]) : 1;
            if (width > 0)
                result_.mesh.attributes.push_back({properties[p].name, MeshAttribute::Domain::vertex, width,
                                                   vertices.columns[p].values, number_of(properties[p].type)});
            else
                note_dropped(properties[p].name);
        }
    }

    static std::array<int, 2> texture_columns(const PlyTable& vertices) {
        for (const auto& [first, second] : texture_names) {
            const std::array<int, 2> found = {vertices.find(first), vertices.find(second)};
            const auto is_number = [&](int p) {
                return p >= 0 && !vertices.element->properties[static_cast<std::size_t>(p)].is_list;
            };
            if (is_number(found[0]) && is_number(found[1]))
                return found;
        }
        return {-1, -1};
    }

    void add_texture(const PlyColumn& first, const PlyColumn& second) {
        MeshAttribute uv{"uv", MeshAttribute::Domain::vertex, 2, {}};
        for (std::size_t i = 0; i < first.values.size(); ++i) {
            uv.values.push_back(first.values[i]);
            uv.values.push_back(second.values[i]);
        }
        result_.mesh.attributes.push_back(std::move(uv));
    }

    void add_face_attributes(const PlyTable& faces, std::size_t corners) {
        for (std::size_t p = 0; p < faces.columns.size(); ++p) {
            const PlyProperty& property = faces.element->properties[p];
            const PlyColumn& column = faces.columns[p];
            if (p == corners)
                continue;
            if (is_corner_property(property)) {
                add_corner_attribute(property, column, faces.columns[corners]);
                continue;
            }
            const int width = property.is_list ? common_size(column) : 1;
            if (width > 0)
                add(polygons_.face_attribute(property.name, width, column.values), property);
            else
                note_dropped(property.name);
        }
    }

    static bool is_corner_property(const PlyProperty& property) {
        return property.is_list && (property.name == "texcoord" || property.name.starts_with("corner_"));
    }

    /// A list that holds the values of all corners of a face one after the other.
    void add_corner_attribute(const PlyProperty& property, const PlyColumn& column, const PlyColumn& corners) {
        const std::uint32_t width = corners.sizes.empty() ? 0 : column.sizes[0] / corners.sizes[0];
        bool fits = width > 0;
        for (std::size_t f = 0; f < corners.sizes.size(); ++f)
            fits = fits && column.sizes[f] == width * std::uint64_t{corners.sizes[f]};
        if (!fits)
            return note_dropped(property.name);
        const std::string name =
            property.name == "texcoord" ? "uv" : property.name.substr(std::string_view("corner_").size());
        add(polygons_.corner_attribute(name, static_cast<int>(width), column.values), property);
    }

    void add(MeshAttribute attribute, const PlyProperty& property) {
        attribute.number = number_of(property.type);
        result_.mesh.attributes.push_back(std::move(attribute));
    }

    void note_dropped(const std::string& name) {
        result_.notes.push_back("property " + in_quotes(name) + " left out: its lists differ in length");
    }

    std::string file_;
    PlyHeader header_;
    PlyBody body_; ///< points into header_
    PolygonFan polygons_;
    MeshFile result_;
};

} // namespace

MeshFile read_ply(std::string_view bytes, const std::string& file) {
    return PlyReader(bytes, file).read();
}

} // namespace plisse
