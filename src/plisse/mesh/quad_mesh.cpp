#include <plisse/mesh/quad_mesh.h>

#include <algorithm>
#include <cassert>
#include <string>
#include <tuple>

#include <fmt/format.h>

#include <plisse/base/error.h>
#include <plisse/mesh/mesh_formats.h>
#include <plisse/mesh/quad_connectivity.h>

namespace plisse {

namespace {

constexpr const char* wanted = "give an OBJ file of quadrilaterals";
constexpr int lowest_valence = 3, highest_valence = 8;

/// Refuses what subdivision cannot use.
class Checker {
public:
    Checker(const QuadMesh& mesh, std::span<const int> lines, std::string file)
        : mesh_(mesh), lines_(lines), file_(std::move(file)) {}

    void run() const {
        check_corners();
        check_edges();
        check_vertices();
    }

private:
    std::string vertex_text(int v) const {
        const Vec3 p = mesh_.positions.col(v);
        return fmt::format("{} at ({:.6g}, {:.6g}, {:.6g})", v, p.x(), p.y(), p.z());
    }

    std::string place(int face) const { return file_ + ":" + std::to_string(lines_[static_cast<std::size_t>(face)]); }

    void check_corners() const {
        for (int f = 0; f < mesh_.face_count(); ++f) {
            Quad face = mesh_.faces[static_cast<std::size_t>(f)];
            std::sort(face.begin(), face.end());
            const auto twice = std::adjacent_find(face.begin(), face.end());
            if (twice != face.end())
                throw InputError(place(f), "a face uses vertex " + vertex_text(*twice) + " twice",
                                 "give four different corners");
        }
    }

    void check_edges() const {
        std::vector<std::tuple<int, int, int, bool>> sides; // lower end, higher end, face, runs upward
        for (int f = 0; f < mesh_.face_count(); ++f)
            for (std::size_t k = 0; k < 4; ++k) {
                const Quad& face = mesh_.faces[static_cast<std::size_t>(f)];
                const int a = face[k], b = face[(k + 1) % 4];
                sides.emplace_back(std::min(a, b), std::max(a, b), f, a < b);
            }
        std::sort(sides.begin(), sides.end());
        for (std::size_t s = 1; s < sides.size(); ++s) {
            const auto same_edge = [&](std::size_t i, std::size_t j) {
                return std::get<0>(sides[i]) == std::get<0>(sides[j]) && std::get<1>(sides[i]) == std::get<1>(sides[j]);
            };
            const auto& [a, b, face, upward] = sides[s];
            if (s > 1 && same_edge(s, s - 2))
                throw InputError(place(face), "a third face at the edge " + edge_text(a, b),
                                 "let at most two faces share an edge");
            if (same_edge(s, s - 1) && std::get<3>(sides[s - 1]) == upward)
                throw InputError(place(face), "a face turns against its neighbour at the edge " + edge_text(a, b),
                                 "orient all faces of a sheet alike");
        }
    }

    std::string edge_text(int a, int b) const { return "from " + vertex_text(a) + " to " + vertex_text(b); }

    void check_vertices() const {
        std::vector<int> corners(static_cast<std::size_t>(mesh_.vertex_count()), 0);
        for (const Quad& face : mesh_.faces)
            for (int v : face)
                ++corners[static_cast<std::size_t>(v)];
        const QuadConnectivity connectivity(mesh_.vertex_count(), mesh_.faces);
        for (int v = 0; v < mesh_.vertex_count(); ++v) {
            const int valence = corners[static_cast<std::size_t>(v)];
            if (valence == 0)
                throw InputError(file_, "no face uses vertex " + vertex_text(v), "leave out vertices without faces");
            if (static_cast<int>(connectivity.star(v).size()) < valence)
                throw InputError(file_, "surfaces touch in vertex " + vertex_text(v),
                                 "let the faces around a vertex hang together across edges");
            if (!connectivity.is_boundary_vertex(v) && (valence < lowest_valence || valence > highest_valence))
                throw InputError(file_, fmt::format("{} faces meet in vertex {}", valence, vertex_text(v)),
                                 fmt::format("let {} to {} faces meet within the surface, best four", lowest_valence,
                                             highest_valence));
        }
    }

    const QuadMesh& mesh_;
    std::span<const int> lines_;
    std::string file_;
};

} // namespace

QuadMesh parse_quad_mesh(std::string_view bytes, const std::filesystem::path& path) {
    const std::string file = path.string();
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    if (extension != ".obj")
        throw InputError(file, "is no OBJ file by its name", wanted);
    const ObjPolygons polygons = read_obj_polygons(bytes, file);
    if (polygons.lines.empty())
        throw InputError(file, "has no faces", wanted);
    QuadMesh mesh;
    mesh.positions = to_positions(polygons.points);
    for (std::size_t p = 0; p < polygons.lines.size(); ++p) {
        const auto corners = polygons.polygon(p);
        if (corners.size() != 4)
            throw InputError(file + ":" + std::to_string(polygons.lines[p]),
                             "a face with " + std::to_string(corners.size()) + " corners",
                             "subdivision surfaces are made of faces with four");
        mesh.faces.push_back({corners[0], corners[1], corners[2], corners[3]});
    }
    Checker(mesh, polygons.lines, file).run();
    return mesh;
}

QuadMesh read_quad_mesh(const std::filesystem::path& path) {
    return parse_quad_mesh(read_mesh_bytes(path, wanted), path);
}

QuadMesh quad_sheet(const std::array<double, 2>& size, const std::array<int, 2>& cells) {
    const auto [nx, nz] = cells;
    assert(nx >= 1 && nz >= 1 && size[0] > 0 && size[1] > 0);
    // Mirror images to the bit.
    const auto coordinate = [](int i, int n, double length) { return length * (2 * i - n) / (2.0 * n); };
    QuadMesh mesh;
    mesh.positions.resize(3, (nx + 1) * (nz + 1));
    for (int j = 0; j <= nz; ++j)
        for (int i = 0; i <= nx; ++i)
            mesh.positions.col(j * (nx + 1) + i) = Vec3(coordinate(i, nx, size[0]), 0, coordinate(j, nz, size[1]));
    for (int j = 0; j < nz; ++j)
        for (int i = 0; i < nx; ++i) {
            const int a = j * (nx + 1) + i;
            const int b = a + nx + 1;
            mesh.faces.push_back({a, b, b + 1, a + 1});
        }
    return mesh;
}

} // namespace plisse
