#include <plisse/contact/clearances.h>

#include <algorithm>
#include <limits>
#include <tuple>

#include <plisse/contact/candidates.h>

namespace plisse {

Clearances::Clearances(const CollisionMesh& mesh, double beyond) : mesh_(mesh) {
    Candidates candidates(mesh, beyond, false);
    candidates.find_around(mesh.rest);
    for (const StencilKind kind : {StencilKind::point_triangle, StencilKind::edge_edge})
        for (int i = 0; i < candidates.size(kind); ++i) {
            const double distance = candidates.rest_distance(kind, i);
            if (distance >= beyond)
                continue;
            const auto vertices = candidates.vertices(kind, i);
            const auto [first, second] = candidates.primitives(kind, i);
            const int first_part = part_of(vertices[0]), second_part = part_of(vertices[3]);
            if (kind == StencilKind::point_triangle) {
                add_vertex(first, second_part, distance);
                of_face_.push_back({second, first_part, distance});
            } else {
                add_edge(first, second_part, distance);
                add_edge(second, first_part, distance);
            }
        }
    for (auto* clearances : {&of_vertex_, &of_face_, &of_edge_})
        keep_least(*clearances);
}

void Clearances::add_vertex(int vertex, int part, double distance) {
    of_vertex_.push_back({vertex, part, distance});
    for (const int face : mesh_.connectivity.vertex_faces(vertex))
        for (const int edge : mesh_.connectivity.face_edges()[static_cast<std::size_t>(face)]) {
            const Edge& ends = mesh_.edges[static_cast<std::size_t>(edge)];
            if (ends[0] == vertex || ends[1] == vertex)
                add_edge(edge, part, distance);
        }
}

void Clearances::add_edge(int edge, int part, double distance) {
    of_edge_.push_back({edge, part, distance});
    for (const int face : mesh_.connectivity.edge_faces(edge))
        of_face_.push_back({face, part, distance});
}

void Clearances::keep_least(std::vector<Clearance>& clearances) {
    std::sort(clearances.begin(), clearances.end(), [](const Clearance& a, const Clearance& b) {
        return std::tie(a.primitive, a.part, a.distance) < std::tie(b.primitive, b.part, b.distance);
    });
    const auto same_key = [](const Clearance& a, const Clearance& b) {
        return a.primitive == b.primitive && a.part == b.part;
    };
    clearances.erase(std::unique(clearances.begin(), clearances.end(), same_key), clearances.end());
}

double Clearances::find(const std::vector<Clearance>& clearances, int primitive, int part) {
    const auto found = std::partition_point(clearances.begin(), clearances.end(), [&](const Clearance& c) {
        return std::tie(c.primitive, c.part) < std::tie(primitive, part);
    });
    const bool known = found != clearances.end() && found->primitive == primitive && found->part == part;
    return known ? found->distance : std::numeric_limits<double>::infinity();
}

double Clearances::between(StencilKind kind, const std::array<int, 2>& primitives) const {
    const auto [first, second] = primitives;
    if (kind == StencilKind::point_triangle) {
        const int face_part = part_of(mesh_.faces[static_cast<std::size_t>(second)][0]);
        return std::min(find(of_vertex_, first, face_part), find(of_face_, second, part_of(first)));
    }
    const int first_part = part_of(mesh_.edges[static_cast<std::size_t>(first)][0]);
    const int second_part = part_of(mesh_.edges[static_cast<std::size_t>(second)][0]);
    return std::min(find(of_edge_, first, second_part), find(of_edge_, second, first_part));
}

} // namespace plisse
