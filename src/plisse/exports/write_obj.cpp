#include <plisse/exports/write_obj.h>

#include <algorithm>
#include <array>
#include <cctype>

#include <plisse/exports/text_output.h>
#include <plisse/exports/texture_map.h>
#include <plisse/exports/unfinished_files.h>

namespace plisse {

namespace {

using Colors = std::array<const MeshAttribute*, 3>;

/// The attributes red, green and blue; nulls where the mesh has not all three.
Colors find_colors(const TriangleMesh& mesh) {
    Colors colors{};
    constexpr std::array<const char*, 3> names = {"red", "green", "blue"};
    for (const MeshAttribute& attribute : mesh.attributes)
        for (std::size_t k = 0; k < 3; ++k)
            if (attribute.name == names[k] && attribute.domain == MeshAttribute::Domain::vertex && attribute.width == 1)
                colors[k] = &attribute;
    return std::find(colors.begin(), colors.end(), nullptr) == colors.end() ? colors : Colors{};
}

/// From 0 to 1, as OBJ has it.
double color_value(const MeshAttribute& attribute, std::size_t vertex) {
    const double largest = attribute.number == MeshAttribute::Number::real ? 1 : 255;
    return attribute.values[vertex] / largest;
}

void put_vertices(std::string& out, const TriangleMesh& mesh) {
    const Colors colors = find_colors(mesh);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        put_text(out, "v {} {} {}", mesh.positions(0, v), mesh.positions(1, v), mesh.positions(2, v));
        for (const MeshAttribute* color : colors)
            if (color)
                put_text(out, " {}", color_value(*color, static_cast<std::size_t>(v)));
        out += '\n';
    }
}

std::string group_name(std::string name) {
    for (char& c : name)
        if (std::isspace(static_cast<unsigned char>(c)) || std::iscntrl(static_cast<unsigned char>(c)))
            c = '_';
    return name;
}

void put_faces(std::string& out, const TriangleMesh& mesh, const TextureMap& texture, std::span<const int> face_part,
               std::span<const std::string> part_names) {
    int part = -1;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        if (face_part[f] != part) {
            part = face_part[f];
            put_text(out, "g {}\n", group_name(part_names[static_cast<std::size_t>(part)]));
        }
        out += 'f';
        for (std::size_t corner = 0; corner < 3; ++corner) {
            put_text(out, " {}", mesh.faces[f][corner] + 1);
            if (!texture.empty())
                put_text(out, "/{}", texture.faces[f][corner] + 1);
        }
        out += '\n';
    }
}

} // namespace

void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh, std::span<const int> face_part,
               std::span<const std::string> part_names) {
    const TextureMap texture = texture_map(mesh);
    std::string out = "# plisse; metres, +y up\n";
    put_vertices(out, mesh);
    for (const Vec2& point : texture.points)
        put_text(out, "vt {} {}\n", point.x(), point.y());
    put_faces(out, mesh, texture, face_part, part_names);
    OutputFile file(path);
    file.write(out);
    file.close();
}

} // namespace plisse
