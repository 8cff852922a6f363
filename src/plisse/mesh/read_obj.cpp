#include <plisse/mesh/mesh_formats.h>

#include <algorithm>
#include <array>
#include <limits>

#include <plisse/base/error.h>
#include <plisse/mesh/polygons.h>
#include <plisse/mesh/text_lines.h>

namespace plisse {

namespace {

/// Statements that say nothing about the triangles.
constexpr std::array<std::string_view, 24> passed_over = {
    "vn",     "vp",  "g",    "o",    "s",    "l",     "p",    "mg",   "usemtl", "mtllib", "usemap", "maplib",
    "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim",   "hole",   "bevel",  "lod"};

class ObjReader {
public:
    ObjReader(std::string_view bytes, const std::string& file)
        : lines_(bytes, file, '#', TextLines::Continuation::backslash), file_(file) {}

    ObjPolygons read_polygons() {
        read_statements();
        return std::move(polygons_);
    }

    MeshFile read() {
        read_statements();
        for (std::size_t p = 0; p < polygons_.lines.size(); ++p)
            fan_.add(polygons_.polygon(p));
        MeshFile result;
        result.mesh.positions = to_positions(polygons_.points);
        add_colours(result.mesh);
        add_texture_coordinates(result);
        fan_.add_note(result.notes);
        if (unknown_count_ > 0)
            result.notes.push_back(std::to_string(unknown_count_) +
                                   " lines that are no OBJ statement passed over, the first is line " +
                                   std::to_string(unknown_line_));
        result.mesh.faces = std::move(fan_.faces());
        return result;
    }

private:
    /// A reference to an element that the file has not given yet.
    struct Forward {
        int index;
        int line;
        bool texture;
    };

    void read_statements() {
        while (lines_.next())
            read_statement();
        check_forward_references();
    }

    void read_statement() {
        const std::string_view keyword = lines_.words()[0];
        if (keyword == "v")
            read_vertex();
        else if (keyword == "vt")
            read_texture_point();
        else if (keyword == "f" || keyword == "fo")
            read_face();
        else if (std::find(passed_over.begin(), passed_over.end(), keyword) == passed_over.end()) {
            if (unknown_count_++ == 0)
                unknown_line_ = lines_.line();
        }
    }

    void read_vertex() {
        polygons_.points.push_back(lines_.point(1));
        const std::size_t extra = lines_.words().size() - 4;
        if (extra != 3 && extra != 0 && extra != 1 && extra != 4)
            lines_.fail("a vertex with " + std::to_string(3 + extra) + " numbers",
                        "write x y z, or x y z red green blue");
        for (std::size_t k = 0; k < extra; ++k) {
            const double value = lines_.number(4 + k, "a vertex weight or colour");
            if (extra == 3)
                colours_.push_back(value);
        }
    }

    void read_texture_point() {
        const double u = lines_.number(1, "the first texture coordinate");
        const double v = lines_.words().size() > 2 ? lines_.number(2, "the second texture coordinate") : 0.0;
        texture_points_.push_back({u, v});
    }

    void read_face() {
        const auto words = lines_.words();
        if (words.size() < 4)
            lines_.fail("a face with " + std::to_string(words.size() - 1) + " corners", "give at least three corners");
        for (std::size_t k = 1; k < words.size(); ++k)
            read_corner(words[k]);
        polygons_.starts.push_back(static_cast<int>(polygons_.corners.size()));
        polygons_.lines.push_back(lines_.line());
    }

    /// v, v/vt, v//vn or v/vt/vn. Normals are not used, so only the form of their index is checked.
    void read_corner(std::string_view word) {
        const std::size_t first = word.find('/');
        polygons_.corners.push_back(resolve(word, word.substr(0, first), false));
        int texture = -1;
        if (first != word.npos) {
            const std::string_view rest = word.substr(first + 1);
            const std::size_t second = rest.find('/');
            if (second != 0)
                texture = resolve(word, rest.substr(0, second), true);
            long long normal = 0;
            if (second != rest.npos && !parse_integer(rest.substr(second + 1), normal))
                bad_corner(word);
        }
        corner_textures_.push_back(texture);
        textures_match_ = textures_match_ && texture == polygons_.corners.back();
    }

    [[noreturn]] void bad_corner(std::string_view word) const {
        lines_.fail(in_quotes(word) + " is no face corner", "write a corner as v, v/vt, v//vn or v/vt/vn");
    }

    /// The element that the index in a corner stands for, counted from 0.
    int resolve(std::string_view corner, std::string_view word, bool texture) {
        long long index = 0;
        if (!parse_integer(word, index))
            bad_corner(corner);
        const auto known = static_cast<long long>(texture ? texture_points_.size() : polygons_.points.size());
        const char* kind = texture ? "texture point " : "vertex ";
        if (index == 0 || index < -known)
            lines_.fail(std::string("a face refers to ") + kind + std::to_string(index) + ", of " +
                            std::to_string(known) + " so far",
                        "count from 1, or backwards from -1");
        if (index < 0)
            return static_cast<int>(known + index);
        if (index > std::numeric_limits<int>::max())
            lines_.fail(std::string("a face refers to ") + kind + std::to_string(index),
                        "count from 1 to the number there is");
        if (index > known)
            forward_.push_back({static_cast<int>(index), lines_.line(), texture});
        return static_cast<int>(index - 1);
    }

    void check_forward_references() const {
        for (const Forward& reference : forward_) {
            const std::size_t count = reference.texture ? texture_points_.size() : polygons_.points.size();
            if (static_cast<std::size_t>(reference.index) > count)
                throw InputError(file_ + ":" + std::to_string(reference.line),
                                 std::string("a face refers to ") + (reference.texture ? "texture point " : "vertex ") +
                                     std::to_string(reference.index) + " of " + std::to_string(count),
                                 "count from 1 to the number there is; is the file complete?");
        }
    }

    void add_colours(TriangleMesh& mesh) const {
        if (colours_.empty() || colours_.size() != 3 * polygons_.points.size())
            return;
        static constexpr const char* names[3] = {"red", "green", "blue"};
        for (std::size_t channel = 0; channel < 3; ++channel) {
            MeshAttribute attribute{names[channel], MeshAttribute::Domain::vertex, 1, {}};
            for (std::size_t i = channel; i < colours_.size(); i += 3)
                attribute.values.push_back(colours_[i]);
            mesh.attributes.push_back(std::move(attribute));
        }
    }

    void add_texture_coordinates(MeshFile& result) const {
        if (std::all_of(corner_textures_.begin(), corner_textures_.end(), [](int texture) { return texture < 0; }))
            return;
        if (textures_match_ && texture_points_.size() == polygons_.points.size()) {
            MeshAttribute uv{"uv", MeshAttribute::Domain::vertex, 2, {}};
            for (const auto& point : texture_points_)
                uv.values.insert(uv.values.end(), point.begin(), point.end());
            result.mesh.attributes.push_back(std::move(uv));
            return;
        }
        std::vector<double> values;
        int missing = 0;
        for (int texture : corner_textures_) {
            missing += texture < 0 ? 1 : 0;
            const std::array<double, 2> point =
                texture < 0 ? std::array<double, 2>{0, 0} : texture_points_[static_cast<std::size_t>(texture)];
            values.insert(values.end(), point.begin(), point.end());
        }
        result.mesh.attributes.push_back(fan_.corner_attribute("uv", 2, values));
        if (missing > 0)
            result.notes.push_back(std::to_string(missing) + " face corners without texture coordinates given (0, 0)");
    }

    TextLines lines_;
    std::string file_;
    ObjPolygons polygons_;
    std::vector<double> colours_;
    std::vector<std::array<double, 2>> texture_points_;
    std::vector<int> corner_textures_; ///< texture point of every polygon corner, -1 for none
    bool textures_match_ = true;       ///< every corner has the texture point of its vertex's number
    PolygonFan fan_;
    std::vector<Forward> forward_;
    int unknown_count_ = 0;
    int unknown_line_ = 0;
};

} // namespace

ObjPolygons read_obj_polygons(std::string_view bytes, const std::string& file) {
    return ObjReader(bytes, file).read_polygons();
}

MeshFile read_obj(std::string_view bytes, const std::string& file) {
    return ObjReader(bytes, file).read();
}

} // namespace plisse
