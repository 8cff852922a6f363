#include <plisse/decimate/vertex_state.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <plisse/decimate/patch.h>

namespace plisse {

namespace {

/// Faces with less quality than this have no area to speak of.
constexpr double no_quality = 1e-10;

/// The faces around a vertex, one after the other.
struct Umbrella {
    bool manifold = false;     ///< one fan, consistently turned
    int first = -1, last = -1; ///< boundary neighbours of an open fan, in the order of the faces' turn
};

struct Wedge {
    int from, to; ///< a face's corners after the centre
    bool visited = false;
};

std::vector<Wedge> wedges(const DynamicFaces& faces, int vertex) {
    std::vector<Wedge> result;
    for (int f : faces.vertex_faces(vertex)) {
        const Face& face = faces.face(f);
        const std::size_t c = face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
        result.push_back({face[(c + 1) % 3], face[(c + 2) % 3]});
    }
    return result;
}

Umbrella umbrella(const DynamicFaces& faces, int vertex) {
    std::vector<Wedge> around = wedges(faces, vertex);
    const auto open = std::find_if(around.begin(), around.end(), [&](const Wedge& wedge) {
        return std::none_of(around.begin(), around.end(), [&](const Wedge& other) { return other.to == wedge.from; });
    });
    Wedge* wedge = open != around.end() ? &*open : &around.front();
    const int start = wedge->from;
    int end = start;
    for (std::size_t steps = 0; steps < around.size(); ++steps) {
        if (wedge->visited)
            return {};
        wedge->visited = true;
        end = wedge->to;
        const auto next =
            std::find_if(around.begin(), around.end(), [&](const Wedge& other) { return other.from == end; });
        if (next == around.end() && steps + 1 < around.size())
            return {};
        wedge = next == around.end() ? nullptr : &*next;
    }
    const bool closed = open == around.end();
    if (closed != (end == start) || (!closed && wedge != nullptr))
        return {};
    return closed ? Umbrella{true, -1, -1} : Umbrella{true, start, end};
}

bool turns_by_more(const ConstPositions& rest, int before, int vertex, int after, double degrees) {
    const Vec3 in = rest.col(vertex) - rest.col(before), out = rest.col(after) - rest.col(vertex);
    return in.dot(out) < std::cos(degrees * std::numbers::pi / 180) * in.norm() * out.norm();
}

/// Group of each part: -1 frozen, 0 the counted ones, then one for each obstacle.
std::vector<int> part_groups(const DecimationInput& input, const DecimationOptions& options) {
    int part_count = 0;
    for (int part : input.part)
        part_count = std::max(part_count, part + 1);
    const auto is_frozen = [&](std::size_t p) { return p < input.frozen_part.size() && input.frozen_part[p] != 0; };
    const auto is_obstacle = [&](std::size_t p) {
        return p < options.obstacle_part.size() && options.obstacle_part[p] != 0;
    };
    std::vector<int> groups(part_count, 0);
    bool others = false;
    for (std::size_t p = 0; p < groups.size(); ++p)
        others = others || (!is_frozen(p) && !is_obstacle(p));
    int next = 1;
    for (std::size_t p = 0; p < groups.size(); ++p)
        groups[p] = is_frozen(p) ? -1 : others && is_obstacle(p) ? next++ : 0;
    return groups;
}

bool borders_other_label(const DecimationInput& input, std::span<const int> ring, int label) {
    return std::any_of(ring.begin(), ring.end(), [&](int v) { return input.label[v] != label; });
}

void lock_faces_without_area(const DecimationInput& input, std::vector<VertexState>& states) {
    for (const Face& face : input.faces)
        if (!(face_shape(input.rest.col(face[0]), input.rest.col(face[1]), input.rest.col(face[2])).quality >
              no_quality))
            for (int v : face)
                states[v].locked = true;
}

} // namespace

std::vector<VertexState> vertex_states(const DecimationInput& input, const DecimationOptions& options,
                                       const DynamicFaces& faces) {
    const std::vector<int> groups = part_groups(input, options);
    std::vector<VertexState> states(input.part.size());
    std::vector<int> ring;
    for (int v = 0; v < static_cast<int>(states.size()); ++v) {
        VertexState& state = states[v];
        state.part = input.part[v];
        state.label = input.label.empty() ? -1 : input.label[v];
        if (!faces.has_vertex(v))
            continue;
        state.group = groups[state.part];
        const Umbrella around = umbrella(faces, v);
        state.locked = !around.manifold;
        faces.ring(v, ring);
        state.on_boundary =
            std::any_of(ring.begin(), ring.end(), [&](int other) { return faces.is_boundary_edge(v, other); });
        state.corner =
            around.first >= 0 && turns_by_more(input.rest, around.first, v, around.last, options.corner_angle);
        state.handle_border = state.label >= 0 && borders_other_label(input, ring, state.label);
    }
    lock_faces_without_area(input, states);
    return states;
}

} // namespace plisse
