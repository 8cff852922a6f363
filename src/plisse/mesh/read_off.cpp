#include <plisse/mesh/mesh_formats.h>

#include <algorithm>

#include <plisse/base/error.h>
#include <plisse/mesh/polygons.h>
#include <plisse/mesh/text_lines.h>

namespace plisse {

namespace {

/// [ST][C][N]OFF of Geomview's format: after x, y, z a vertex line may hold a normal and a colour, which are passed
/// over, and last two texture coordinates, which are kept.
class OffReader {
public:
    OffReader(std::string_view bytes, const std::string& file) : lines_(bytes, file, '#'), file_(file) {}

    MeshFile read() {
        read_header();
        for (long long i = 0; i < vertex_count_; ++i)
            read_vertex(i);
        for (long long i = 0; i < face_count_; ++i)
            read_face(i);
        MeshFile result;
        result.mesh.positions = to_positions(points_);
        if (textured_)
            result.mesh.attributes.push_back({"uv", MeshAttribute::Domain::vertex, 2, std::move(texture_)});
        polygons_.add_note(result.notes);
        result.mesh.faces = std::move(polygons_.faces());
        return result;
    }

private:
    void next_line(const std::string& expected) {
        if (!lines_.next())
            throw InputError(file_, "ends before " + expected, "is the file complete?");
    }

    void read_header() {
        next_line("the word OFF");
        std::string_view magic = lines_.words()[0];
        textured_ = magic.starts_with("ST");
        for (std::string_view prefix : {"ST", "C", "N"})
            if (magic.starts_with(prefix))
                magic.remove_prefix(prefix.size());
        if (magic != "OFF")
            lines_.fail(in_quotes(lines_.words()[0]) + " where the word OFF belongs",
                        "begin with OFF, NOFF, COFF or STOFF (points in three dimensions, as text)");
        std::size_t first = 1;
        if (lines_.words().size() > 1 && lines_.words()[1] == "BINARY")
            lines_.fail("binary OFF is not read", "write the file as text, or as PLY");
        if (lines_.words().size() == 1) {
            next_line("the counts of vertices and faces");
            first = 0;
        }
        vertex_count_ = read_count(first, "the count of vertices", 6);
        face_count_ = read_count(first + 1, "the count of faces", 8);
    }

    /// A count that the rest of the file can hold, an element taking at least so many bytes.
    long long read_count(std::size_t word, const char* what, long long bytes_each) const {
        const long long count = lines_.integer(word, what);
        const auto remaining = static_cast<long long>(lines_.remaining());
        if (count < 0 || count > remaining / bytes_each + 1)
            lines_.fail(std::string(what) + " is " + std::to_string(count) + ", more than the file can hold",
                        "write the true count; is the file complete?");
        return count;
    }

    void read_vertex(long long i) {
        next_line("vertex " + std::to_string(i) + " of " + std::to_string(vertex_count_));
        points_.push_back(lines_.point(0));
        const std::size_t count = lines_.words().size();
        if (!textured_)
            return;
        if (count < 5)
            lines_.fail("a vertex without texture coordinates", "end each vertex of a STOFF file with two of them");
        texture_.push_back(lines_.number(count - 2, "the first texture coordinate"));
        texture_.push_back(lines_.number(count - 1, "the second texture coordinate"));
    }

    void read_face(long long i) {
        next_line("face " + std::to_string(i) + " of " + std::to_string(face_count_));
        const long long count = lines_.integer(0, "the number of corners");
        if (count < 3)
            lines_.fail("a face with " + std::to_string(count) + " corners", "give at least three corners");
        if (static_cast<unsigned long long>(count) > lines_.words().size() - 1)
            lines_.fail("a face of " + std::to_string(count) + " corners lists " +
                            std::to_string(lines_.words().size() - 1),
                        "list every corner on the line of its face");
        corners_.clear();
        for (std::size_t k = 1; k <= static_cast<std::size_t>(count); ++k) {
            const long long corner = lines_.integer(k, "a face corner");
            if (corner < 0 || corner >= vertex_count_)
                lines_.fail("a face refers to vertex " + std::to_string(corner) + " of " +
                                std::to_string(vertex_count_),
                            "count from 0 to the number of vertices less one");
            corners_.push_back(static_cast<int>(corner));
        }
        polygons_.add(corners_);
    }

    TextLines lines_;
    std::string file_;
    bool textured_ = false;
    long long vertex_count_ = 0;
    long long face_count_ = 0;
    std::vector<Vec3> points_;
    std::vector<double> texture_;
    std::vector<int> corners_;
    PolygonFan polygons_;
};

} // namespace

MeshFile read_off(std::string_view bytes, const std::string& file) {
    return OffReader(bytes, file).read();
}

} // namespace plisse
