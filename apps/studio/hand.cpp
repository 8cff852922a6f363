#include "hand.h"

#include <algorithm>

#include <fmt/format.h>

#include <plisse/base/error.h>

namespace plisse::studio {

namespace {

constexpr std::size_t most_points = 24;
constexpr double reach = 1.0;        // of the mean edge of the level shown
constexpr double share_of_e_h = 0.3; // of the membrane's stiffness, all springs together

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

double mean_edge(const HierarchyLevel& mesh, int part) {
    double sum = 0;
    int count = 0;
    for (const Face& face : mesh.faces) {
        if (mesh.part[at(face[0])] != part)
            continue;
        for (std::size_t k = 0; k < 3; ++k)
            sum += (mesh.rest.col(face[k]) - mesh.rest.col(face[(k + 1) % 3])).norm();
        count += 3;
    }
    return sum / std::max(count, 1);
}

/// The finest vertices of a body that some face uses.
std::vector<int> used_vertices(const HierarchyLevel& finest, const Body& body) {
    std::vector<bool> used(finest.part.size(), false);
    for (const Face& face : finest.faces)
        for (int v : face)
            used[at(v)] = true;
    std::vector<int> vertices;
    for (int v = body.vertices.begin; v < body.vertices.end; ++v)
        if (used[at(v)])
            vertices.push_back(v);
    return vertices;
}

/// Sorts by distance from a place, the nearest first; of equals the first.
void sort_by_distance(std::vector<int>& vertices, const Positions& points, const Vec3& place) {
    std::stable_sort(vertices.begin(), vertices.end(), [&](int a, int b) {
        return (points.col(a) - place).squaredNorm() < (points.col(b) - place).squaredNorm();
    });
}

} // namespace

nlohmann::ordered_json Hand::pull() const {
    nlohmann::ordered_json json = {{"name", id}, {"body", body}, {"stiffness", stiffness}};
    json["points"] = nlohmann::ordered_json::array();
    for (const Point& point : points) {
        const Vec3 place = to + point.offset;
        json["points"].push_back({{"vertex", point.vertex}, {"to", {place.x(), place.y(), place.z()}}});
    }
    return json;
}

Hand take_hold(const Discretization& discretization, int level, int vertex, const Positions& fine, const Vec3& place) {
    const HierarchyLevel& mesh = discretization.mesh(level);
    const Model& model = discretization.model();
    if (vertex < 0 || vertex >= static_cast<int>(mesh.part.size()) || model.is_obstacle(mesh.part[at(vertex)]))
        throw InputError("grab", fmt::format("no body has vertex {} of level {}", vertex, level),
                         "take hold of a vertex of a body");
    const int part = mesh.part[at(vertex)];
    const Body& body = model.bodies[at(part)];
    const HierarchyLevel& finest = discretization.hierarchy().finest();
    std::vector<int> near = used_vertices(finest, body);
    sort_by_distance(near, fine, place);
    const int center = near.front();
    const Vec3 rest_place = finest.rest.col(center);
    const double radius = reach * mean_edge(mesh, part);
    std::erase_if(near, [&](int v) { return (finest.rest.col(v) - rest_place).norm() > radius; });
    sort_by_distance(near, finest.rest, rest_place);
    near.resize(std::min(near.size(), most_points));

    Hand hand;
    hand.body = body.name;
    hand.to = place;
    const double whole = share_of_e_h * body.material.youngs_modulus * body.material.thickness;
    hand.stiffness = whole / static_cast<double>(near.size());
    for (int v : near)
        hand.points.push_back({v - body.vertices.begin, fine.col(v) - fine.col(center)});
    return hand;
}

} // namespace plisse::studio
