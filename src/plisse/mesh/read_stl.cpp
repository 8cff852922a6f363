#include <plisse/mesh/mesh_formats.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include <plisse/base/error.h>
#include <plisse/mesh/binary_bytes.h>
#include <plisse/mesh/text_lines.h>

namespace plisse {

namespace {

/// Gives bit-identical points one number, in the order in which they first appear. Minus zero counts as zero.
class PointMerger {
public:
    int number(const Vec3& point) {
        const Vec3 p = point + Vec3::Zero();
        const Key key{std::bit_cast<std::uint64_t>(p.x()), std::bit_cast<std::uint64_t>(p.y()),
                      std::bit_cast<std::uint64_t>(p.z())};
        const auto [place, is_new] = numbers_.try_emplace(key, static_cast<int>(points_.size()));
        if (is_new)
            points_.push_back(p);
        return place->second;
    }
    const std::vector<Vec3>& points() const { return points_; }

private:
    using Key = std::array<std::uint64_t, 3>;
    struct Hash {
        std::size_t operator()(const Key& key) const {
            std::uint64_t hash = 0;
            for (std::uint64_t word : key)
                hash = (hash ^ (word ^ (word >> 29))) * 0x9e3779b97f4a7c15ULL;
            return static_cast<std::size_t>(hash ^ (hash >> 32));
        }
    };
    std::unordered_map<Key, int, Hash> numbers_;
    std::vector<Vec3> points_;
};

constexpr std::size_t header_size = 84;
constexpr std::size_t triangle_size = 50;

std::uint32_t binary_triangle_count(std::string_view bytes) {
    return BinaryBytes(bytes.substr(80), std::endian::little).take<std::uint32_t>();
}

/// Binary files may begin with the word "solid" too, so the size decides before the word does.
bool is_binary(std::string_view bytes) {
    if (bytes.size() >= header_size &&
        bytes.size() == header_size + triangle_size * std::size_t{binary_triangle_count(bytes)})
        return true;
    const std::size_t start = bytes.find_first_not_of(" \t\r\n");
    return start == bytes.npos || !bytes.substr(start).starts_with("solid");
}

TriangleMesh read_binary(std::string_view bytes, const std::string& file) {
    if (bytes.size() < header_size)
        throw InputError(file, "is neither text that begins with the word solid nor a binary STL file",
                         "is the file complete?");
    const std::size_t count = binary_triangle_count(bytes);
    if (count > (bytes.size() - header_size) / triangle_size)
        throw InputError(file,
                         "announces " + std::to_string(count) + " triangles and holds " +
                             std::to_string((bytes.size() - header_size) / triangle_size),
                         "is the file complete?");
    BinaryBytes data(bytes.substr(header_size), std::endian::little);
    PointMerger merger;
    TriangleMesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k)
            data.take<float>(); // the normal: the corners say the same
        Face face;
        for (int& corner : face) {
            Vec3 p;
            for (int k = 0; k < 3; ++k)
                p[k] = data.take<float>();
            if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z()))
                throw InputError(file, "triangle " + std::to_string(i) + " has a coordinate that is not finite",
                                 "write finite numbers");
            corner = merger.number(p);
        }
        data.take<std::uint16_t>();
        mesh.faces.push_back(face);
    }
    mesh.positions = to_positions(merger.points());
    return mesh;
}

class StlTextReader {
public:
    StlTextReader(std::string_view bytes, const std::string& file) : lines_(bytes, file, 0), file_(file) {}

    TriangleMesh read() {
        TriangleMesh mesh;
        while (lines_.next()) {
            const std::string_view word = lines_.words()[0];
            if (word == "facet")
                mesh.faces.push_back(read_facet());
            else if (word == "solid")
                enter_solid();
            else if (word == "endsolid")
                inside_ = false;
            else
                lines_.fail(in_quotes(word) + " where a facet belongs", "write facet, solid or endsolid");
        }
        if (inside_)
            throw InputError(file_, "ends before endsolid", "is the file complete?");
        mesh.positions = to_positions(merger_.points());
        return mesh;
    }

private:
    void enter_solid() {
        if (inside_)
            lines_.fail("a solid begins inside another", "end a solid with endsolid");
        inside_ = true;
    }

    Face read_facet() {
        Face face;
        expect("outer");
        for (int& corner : face) {
            expect("vertex");
            corner = merger_.number(lines_.point(1));
        }
        expect("endloop");
        expect("endfacet");
        return face;
    }

    void expect(const char* word) {
        if (!lines_.next())
            throw InputError(file_, std::string("ends where '") + word + "' belongs", "is the file complete?");
        if (lines_.words()[0] != word)
            lines_.fail(in_quotes(lines_.words()[0]) + " where '" + word + "' belongs",
                        "write a facet as outer loop, three vertex lines, endloop, endfacet");
    }

    TextLines lines_;
    std::string file_;
    PointMerger merger_;
    bool inside_ = false;
};

} // namespace

MeshFile read_stl(std::string_view bytes, const std::string& file) {
    return {is_binary(bytes) ? read_binary(bytes, file) : StlTextReader(bytes, file).read(), {}};
}

} // namespace plisse
