#include <plisse/mesh/write_ply.h>

#include <cassert>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <unistd.h>

#include <plisse/mesh/binary_bytes.h>

namespace plisse {

namespace {

using Domain = MeshAttribute::Domain;
using Number = MeshAttribute::Number;

void put_number(std::string& out, Number number, double value) {
    if (number == Number::real)
        put_little_endian(out, value);
    else if (number == Number::int32)
        put_little_endian(out, static_cast<std::int32_t>(value));
    else
        put_little_endian(out, static_cast<std::uint8_t>(value));
}

const char* type_name(Number number) {
    return number == Number::real ? "double" : number == Number::int32 ? "int" : "uchar";
}

/// Numbers a face or vertex holds of an attribute.
int row_width(const MeshAttribute& attribute) {
    return attribute.domain == Domain::corner ? 3 * attribute.width : attribute.width;
}

bool is_vertex_texture(const MeshAttribute& attribute) {
    return attribute.domain == Domain::vertex && attribute.name == "uv" && attribute.width == 2;
}

bool is_list(const MeshAttribute& attribute) {
    return attribute.domain == Domain::corner || (attribute.width > 1 && !is_vertex_texture(attribute));
}

/// Lists are counted by a byte where it can hold the length.
bool has_long_list(const MeshAttribute& attribute) {
    return row_width(attribute) > 255;
}

std::string declaration(const MeshAttribute& attribute) {
    const std::string type = type_name(attribute.number);
    if (is_vertex_texture(attribute))
        return "property " + type + " s\nproperty " + type + " t\n";
    std::string name = attribute.name;
    if (attribute.domain == Domain::corner)
        name = name == "uv" ? "texcoord" : "corner_" + name;
    const std::string list = is_list(attribute) ? (has_long_list(attribute) ? "list int " : "list uchar ") : "";
    return "property " + list + type + " " + name + "\n";
}

void put_row(std::string& out, const MeshAttribute& attribute, int row) {
    const int width = row_width(attribute);
    if (is_list(attribute)) {
        if (has_long_list(attribute))
            put_little_endian(out, static_cast<std::int32_t>(width));
        else
            put_little_endian(out, static_cast<std::uint8_t>(width));
    }
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
    for (std::size_t k = 0; k < static_cast<std::size_t>(width); ++k)
        put_number(out, attribute.number, attribute.values[first + k]);
}

/// The attributes of vertices, or those of faces and their corners. face_body takes the place of a face attribute
/// "body".
std::vector<const MeshAttribute*> written_attributes(const TriangleMesh& mesh, bool of_vertices, bool with_body) {
    std::vector<const MeshAttribute*> result;
    for (const MeshAttribute& attribute : mesh.attributes) {
        const bool replaced = with_body && attribute.domain == Domain::face && attribute.name == "body";
        if ((attribute.domain == Domain::vertex) == of_vertices && !replaced)
            result.push_back(&attribute);
    }
    return result;
}

std::string ply_bytes(const TriangleMesh& mesh, std::span<const int> face_body) {
    const auto of_vertices = written_attributes(mesh, true, false);
    const auto of_faces = written_attributes(mesh, false, !face_body.empty());
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment units: m\n";
    out += "element vertex " + std::to_string(mesh.vertex_count()) + "\n";
    out += "property double x\nproperty double y\nproperty double z\n";
    for (const MeshAttribute* attribute : of_vertices)
        out += declaration(*attribute);
    out += "element face " + std::to_string(mesh.face_count()) + "\nproperty list uchar int vertex_indices\n";
    if (!face_body.empty())
        out += "property int body\n";
    for (const MeshAttribute* attribute : of_faces)
        out += declaration(*attribute);
    out += "end_header\n";

    for (int v = 0; v < mesh.vertex_count(); ++v) {
        for (int k = 0; k < 3; ++k)
            put_little_endian(out, mesh.positions(k, v));
        for (const MeshAttribute* attribute : of_vertices)
            put_row(out, *attribute, v);
    }
    for (int f = 0; f < mesh.face_count(); ++f) {
        put_little_endian(out, std::uint8_t{3});
        for (int corner : mesh.faces[static_cast<std::size_t>(f)])
            put_little_endian(out, static_cast<std::int32_t>(corner));
        if (!face_body.empty())
            put_little_endian(out, static_cast<std::int32_t>(face_body[static_cast<std::size_t>(f)]));
        for (const MeshAttribute* attribute : of_faces)
            put_row(out, *attribute, f);
    }
    return out;
}

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
    throw std::runtime_error(path.string() + ": cannot be written: " + std::strerror(error));
}

/// Writes all bytes and makes them durable; 0, or the error number.
int write_durably(const std::filesystem::path& path, const std::string& bytes) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0)
        return errno;
    int error = 0;
    for (std::size_t done = 0; done < bytes.size() && error == 0;) {
        const ssize_t count = ::write(file, bytes.data() + done, bytes.size() - done);
        if (count >= 0)
            done += static_cast<std::size_t>(count);
        else if (errno != EINTR)
            error = errno;
    }
    if (error == 0 && ::fsync(file) != 0)
        error = errno;
    if (::close(file) != 0 && error == 0)
        error = errno;
    return error;
}

} // namespace

void write_ply(const std::filesystem::path& path, const TriangleMesh& mesh, std::span<const int> face_body) {
    assert(face_body.empty() || face_body.size() == mesh.faces.size());
    std::filesystem::path partial = path;
    partial += ".partial-" + std::to_string(::getpid());
    int error = write_durably(partial, ply_bytes(mesh, face_body));
    if (error == 0 && std::rename(partial.c_str(), path.c_str()) != 0)
        error = errno;
    if (error != 0) {
        ::unlink(partial.c_str());
        fail(path, error);
    }
}

} // namespace plisse
