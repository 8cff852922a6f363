#include <plisse/decimate/vertex_state.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <plisse/decimate/patch.h>
#include <plisse/mesh/unions.h>

namespace plisse {

namespace {

/// Faces with less quality than this have no area to speak of.
constexpr double no_quality = 1e-10;

/// How the faces around a vertex hang together.
struct Surroundings {
    bool sound = false; ///< across edges, and faces of a sheet turn alike
    bool on_curve = false, joint = false;
    bool regular = false;        ///< one curve runs through, which all sheets end at
    int before = -1, after = -1; ///< of a regular vertex: neighbours on the curve
};

class FacesAround {
public:
    FacesAround(const DynamicFaces& faces, int vertex) {
        for (int f : faces.vertex_faces(vertex)) {
            const Face& face = faces.face(f);
            const std::size_t c = face[0] == vertex ? 0 : face[1] == vertex ? 1 : 2;
            const int place = face_count_++;
            spokes_.push_back({face[(c + 1) % 3], place, true});
            spokes_.push_back({face[(c + 2) % 3], place, false});
        }
        std::sort(spokes_.begin(), spokes_.end(), [](const Spoke& a, const Spoke& b) {
            return std::tie(a.neighbour, a.face) < std::tie(b.neighbour, b.face);
        });
    }

    Surroundings describe() const {
        Surroundings result;
        Unions fans(face_count_), all(face_count_);
        std::vector<std::span<const Spoke>> curves;
        bool turn_alike = true;
        for (std::size_t begin = 0, end = 0; begin < spokes_.size(); begin = end) {
            while (end < spokes_.size() && spokes_[end].neighbour == spokes_[begin].neighbour)
                ++end;
            const auto edge = std::span(spokes_).subspan(begin, end - begin);
            for (const Spoke& spoke : edge)
                all.join(edge.front().face, spoke.face);
            if (edge.size() == 2) {
                fans.join(edge[0].face, edge[1].face);
                turn_alike = turn_alike && edge[0].leaves != edge[1].leaves;
            } else {
                curves.push_back(edge);
                result.joint = result.joint || edge.size() > 2;
            }
        }
        result.on_curve = !curves.empty();
        result.sound = turn_alike && count(all) == 1;
        if (curves.size() != 2 || !end_alike(curves[0], curves[1], fans))
            return result;
        result.regular = true;
        const bool swapped = !curves[0].front().leaves; // a boundary runs with the surface on its left
        result.before = curves[swapped ? 1 : 0].front().neighbour;
        result.after = curves[swapped ? 0 : 1].front().neighbour;
        return result;
    }

private:
    /// An edge at the vertex as a side of a face.
    struct Spoke {
        int neighbour, face;
        bool leaves; ///< whether the face runs from the vertex to the neighbour
    };

    int count(Unions& unions) const {
        int result = 0;
        for (int f = 0; f < face_count_; ++f)
            result += unions.root(f) == f;
        return result;
    }

    /// Whether each fan has one side on either curve edge.
    static bool end_alike(std::span<const Spoke> a, std::span<const Spoke> b, Unions& fans) {
        const auto roots = [&](std::span<const Spoke> edge) {
            std::vector<int> result;
            for (const Spoke& spoke : edge)
                result.push_back(fans.root(spoke.face));
            std::sort(result.begin(), result.end());
            return result;
        };
        const std::vector<int> of_a = roots(a);
        return of_a == roots(b) && std::adjacent_find(of_a.begin(), of_a.end()) == of_a.end();
    }

    std::vector<Spoke> spokes_;
    int face_count_ = 0;
};

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
        const Surroundings around = FacesAround(faces, v).describe();
        state.locked = !around.sound;
        state.on_curve = around.on_curve;
        state.joint = around.joint;
        state.corner = around.on_curve && (!around.regular || turns_by_more(input.rest, around.before, v, around.after,
                                                                            options.corner_angle));
        faces.ring(v, ring);
        state.handle_border = state.label >= 0 && borders_other_label(input, ring, state.label);
    }
    lock_faces_without_area(input, states);
    return states;
}

} // namespace plisse
