#include <plisse/mesh/check_mesh.h>

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <plisse/mesh/sheet_graph.h>
#include <plisse/spatial/intersections.h>

namespace plisse {

namespace {

bool repeats_a_vertex(const Face& face) {
    return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

/// Zero area up to the round-off of its own computation, whatever the size of the triangle.
bool has_no_area(const Positions& positions, const Face& face) {
    Vec3 u = positions.col(face[1]) - positions.col(face[0]);
    Vec3 v = positions.col(face[2]) - positions.col(face[0]);
    const double largest = std::max(u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff());
    if (!(largest > 0))
        return true;
    u /= largest;
    v /= largest;
    return !(u.cross(v).norm() > 1e-14);
}

std::vector<int> find_degenerate_faces(const TriangleMesh& mesh) {
    std::vector<int> result;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const Face& face = mesh.faces[static_cast<std::size_t>(f)];
        if (repeats_a_vertex(face) || has_no_area(mesh.positions, face))
            result.push_back(f);
    }
    return result;
}

std::vector<int> find_duplicate_faces(std::span<const Face> faces) {
    std::vector<std::pair<Face, int>> sorted;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        Face key = faces[f];
        std::sort(key.begin(), key.end());
        sorted.emplace_back(key, static_cast<int>(f));
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<int> result;
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i].first == sorted[i - 1].first)
            result.push_back(sorted[i].second);
    std::sort(result.begin(), result.end());
    return result;
}

/// Whether a face runs along the edge from its lower to its higher vertex.
bool runs_upward(const Face& face, const Edge& edge) {
    for (std::size_t k = 0; k < 3; ++k)
        if (face[k] == edge[0] && face[(k + 1) % 3] == edge[1])
            return true;
    return false;
}

std::vector<Edge> find_inconsistent_edges(const Connectivity& connectivity, std::span<const Face> faces) {
    std::vector<Edge> result;
    for (int e = 0; e < connectivity.edge_count(); ++e) {
        if (connectivity.is_curve_edge(e))
            continue;
        const auto sides = connectivity.edge_faces(e);
        const Edge& edge = connectivity.edges()[static_cast<std::size_t>(e)];
        if (runs_upward(faces[static_cast<std::size_t>(sides[0])], edge) ==
            runs_upward(faces[static_cast<std::size_t>(sides[1])], edge))
            result.push_back(edge);
    }
    return result;
}

/// Number of groups of faces around a vertex that hang together across edges at the vertex.
int fan_count(int vertex, std::span<const int> around, std::span<const Face> faces) {
    std::vector<std::pair<int, int>> spokes; // other end of an edge at the vertex, face (by its place in `around`)
    for (std::size_t i = 0; i < around.size(); ++i)
        for (int corner : faces[static_cast<std::size_t>(around[i])])
            if (corner != vertex)
                spokes.emplace_back(corner, static_cast<int>(i));
    std::sort(spokes.begin(), spokes.end());
    std::vector<int> fan(around.size());
    std::iota(fan.begin(), fan.end(), 0);
    auto count = static_cast<int>(around.size());
    for (std::size_t s = 1; s < spokes.size(); ++s) {
        if (spokes[s].first != spokes[s - 1].first)
            continue;
        const int kept = fan[static_cast<std::size_t>(spokes[s - 1].second)];
        const int merged = fan[static_cast<std::size_t>(spokes[s].second)];
        if (kept == merged)
            continue;
        std::replace(fan.begin(), fan.end(), merged, kept);
        --count;
    }
    return count;
}

std::vector<int> find_non_manifold_vertices(const Connectivity& connectivity, std::span<const Face> faces) {
    std::vector<int> result;
    for (int v = 0; v < connectivity.vertex_count(); ++v)
        if (fan_count(v, connectivity.vertex_faces(v), faces) > 1)
            result.push_back(v);
    return result;
}

int highest(const std::vector<int>& numbers) {
    return numbers.empty() ? -1 : *std::max_element(numbers.begin(), numbers.end());
}

std::vector<std::array<int, 2>> find_intersections(const TriangleMesh& mesh, const std::vector<int>& degenerate) {
    std::vector<bool> left_out(mesh.faces.size(), false);
    for (int f : degenerate)
        left_out[static_cast<std::size_t>(f)] = true;
    return intersecting_pairs(mesh.positions, mesh.faces, [&](int a, int b) {
        return left_out[static_cast<std::size_t>(a)] || left_out[static_cast<std::size_t>(b)];
    });
}

std::string point_text(const TriangleMesh& mesh, int vertex) {
    const Vec3 p = mesh.positions.col(vertex);
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

/// "3 NOUNS: place, place, place and 7 more"; nothing for an empty list.
template <typename Item, typename Place>
void describe(std::vector<std::string>& sentences, const std::vector<Item>& items, const char* one, const char* many,
              const Place& place) {
    constexpr std::size_t shown = 3;
    if (items.empty())
        return;
    std::string text = fmt::format("{} {}: ", items.size(), items.size() == 1 ? one : many);
    for (std::size_t i = 0; i < std::min(items.size(), shown); ++i)
        text += (i > 0 ? ", " : "") + place(items[i]);
    if (items.size() > shown)
        text += fmt::format(" and {} more", items.size() - shown);
    sentences.push_back(text);
}

} // namespace

bool MeshCheck::usable() const {
    return faces > 0 && inconsistent_edges.empty() && non_manifold_vertices.empty() && degenerate_faces.empty() &&
           duplicate_faces.empty() && intersecting_faces.empty();
}

MeshCheck check_mesh(const TriangleMesh& mesh) {
    MeshCheck check;
    check.vertices = mesh.vertex_count();
    check.faces = mesh.face_count();
    check.degenerate_faces = find_degenerate_faces(mesh);
    check.duplicate_faces = find_duplicate_faces(mesh.faces);

    // A face that repeats a vertex has no three edges; the others still have a topology to speak of.
    std::vector<Face> faces;
    std::copy_if(mesh.faces.begin(), mesh.faces.end(), std::back_inserter(faces),
                 [](const Face& face) { return !repeats_a_vertex(face); });
    const Connectivity connectivity(check.vertices, faces);
    for (int e : connectivity.non_manifold_edges())
        check.non_manifold_edges.push_back(connectivity.edges()[static_cast<std::size_t>(e)]);
    check.inconsistent_edges = find_inconsistent_edges(connectivity, faces);
    check.non_manifold_vertices = find_non_manifold_vertices(connectivity, faces);
    check.boundary_loops = static_cast<int>(boundary_pieces(connectivity).size());
    check.sheets = sheet_graph(connectivity).sheets;
    const std::vector<int> component = components(check.vertices, faces);
    check.components = highest(component) + 1;
    check.unreferenced_vertices = static_cast<int>(std::count(component.begin(), component.end(), -1));
    check.euler_characteristic =
        check.vertices - check.unreferenced_vertices - connectivity.edge_count() + static_cast<int>(faces.size());
    check.intersecting_faces = find_intersections(mesh, check.degenerate_faces);
    return check;
}

std::vector<std::string> describe_findings(const MeshCheck& check, const TriangleMesh& mesh) {
    const auto vertex = [&](int v) { return fmt::format("{} at {}", v, point_text(mesh, v)); };
    const auto edge = [&](const Edge& e) { return fmt::format("{}-{} at {}", e[0], e[1], point_text(mesh, e[0])); };
    const auto face = [&](int f) {
        return fmt::format("{} at {}", f, point_text(mesh, mesh.faces[static_cast<std::size_t>(f)][0]));
    };
    const auto pair = [&](const std::array<int, 2>& p) {
        return fmt::format("{} and {} at {}", p[0], p[1],
                           point_text(mesh, mesh.faces[static_cast<std::size_t>(p[0])][0]));
    };
    std::vector<std::string> sentences;
    if (check.faces == 0)
        sentences.push_back("no faces");
    describe(sentences, check.inconsistent_edges, "edge whose two faces turn opposite ways",
             "edges whose two faces turn opposite ways", edge);
    describe(sentences, check.non_manifold_vertices, "vertex where surfaces touch in a point",
             "vertices where surfaces touch in a point", vertex);
    describe(sentences, check.degenerate_faces, "degenerate face", "degenerate faces", face);
    describe(sentences, check.duplicate_faces, "duplicate face", "duplicate faces", face);
    describe(sentences, check.intersecting_faces, "pair of intersecting faces", "pairs of intersecting faces", pair);
    return sentences;
}

} // namespace plisse
