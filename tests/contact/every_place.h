#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <plisse/contact/collision_mesh.h>
#include <plisse/contact/contact_options.h>
#include <plisse/geometry/barrier.h>

#include "geometry/reference_distance.h"

namespace plisse {

inline Stencil points_of(const Positions& x, const std::array<int, 4>& vertices) {
    Stencil stencil;
    for (int i = 0; i < 4; ++i)
        stencil.col(i) = x.col(vertices[static_cast<std::size_t>(i)]);
    return stencil;
}

/// The primitives' boxes tell, in less time than a distance takes.
inline bool surely_beyond(double distance, StencilKind kind, const Stencil& x) {
    const int first_size = kind == StencilKind::point_triangle ? 1 : 2;
    const Vec3 low = x.leftCols(first_size).rowwise().minCoeff(), high = x.leftCols(first_size).rowwise().maxCoeff();
    const auto other = x.rightCols(4 - first_size);
    const double slack = distance * (1 + 1e-9);
    return (other.rowwise().minCoeff().array() > high.array() + slack).any() ||
           (other.rowwise().maxCoeff().array() < low.array() - slack).any();
}

/// What repels: a point and a face, an edge {v, a, b, b} or a vertex {v, a, a, a}, `count` times, or two edges.
struct Place {
    StencilKind kind = StencilKind::point_triangle;
    std::array<int, 4> vertices{};
    int count = 1;
    double area = 0;           ///< m^2
    PairRange range;           ///< the least of the faces'
    std::set<int> ends;        ///< of two edges: points of the stencil that repel by themselves too
    bool counts_as_gap = true; ///< of faces and edges that are not near at rest
};

/// All pairs of a mesh by definition.
class EveryPlace {
public:
    EveryPlace(const CollisionMesh& mesh, const ContactOptions& options) : mesh_(mesh), options_(options) {
        find_clearances();
    }

    /// Those within reach at x, and some others.
    template <typename Visit>
    void visit(const Positions& x, const Visit& call) const {
        for (const int v : mesh_.vertices)
            visit_point(v, x, call);
        for (int i = 0; i < size(mesh_.edges); ++i)
            for (int j = i + 1; j < size(mesh_.edges); ++j)
                if (is_near(x, StencilKind::edge_edge, {edge(i)[0], edge(i)[1], edge(j)[0], edge(j)[1]}) &&
                    corners_of(edge(i), edge(j)).size() == 4 && may_meet(edge(i)[0], edge(j)[0]))
                    call(two_edges(i, j));
    }

private:
    using Key = std::pair<std::set<int>, int>; ///< a primitive's corners, and a part

    template <typename T>
    static int size(const std::vector<T>& list) {
        return static_cast<int>(list.size());
    }
    const Edge& edge(int i) const { return mesh_.edges[static_cast<std::size_t>(i)]; }
    const Face& face(int i) const { return mesh_.faces[static_cast<std::size_t>(i)]; }
    int part(int v) const { return mesh_.part[static_cast<std::size_t>(v)]; }
    static std::set<int> corners_of(const Edge& a, const Edge& b) { return {a[0], a[1], b[0], b[1]}; }

    bool may_meet(int v, int w) const {
        const auto on_obstacle = [&](int i) { return mesh_.obstacle[static_cast<std::size_t>(part(i))] != 0; };
        return !(on_obstacle(v) && on_obstacle(w)) && (part(v) != part(w) || options_.self);
    }

    bool is_near(const Positions& x, StencilKind kind, const std::array<int, 4>& vertices) const {
        return !surely_beyond(options_.reach(), kind, points_of(x, vertices));
    }

    double at_rest(StencilKind kind, const std::array<int, 4>& v) const {
        const Stencil stencil = points_of(mesh_.rest, v);
        return surely_beyond(2 * options_.reach(), kind, stencil) ? std::numeric_limits<double>::infinity()
                                                                  : reference_distance(kind, stencil);
    }

    /// Every primitive's distance from every other part at rest: the least of anything it contains.
    void find_clearances() {
        std::map<Key, double> own;
        const auto take = [&](const auto& corners, int other_part, double distance) {
            if (distance >= 2 * options_.reach())
                return;
            double& least = own.try_emplace({{corners.begin(), corners.end()}, other_part}, distance).first->second;
            least = std::min(least, distance);
        };
        for (const int v : mesh_.vertices)
            for (const Face& f : mesh_.faces)
                if (part(v) != part(f[0]) && may_meet(v, f[0])) {
                    const double distance = at_rest(StencilKind::point_triangle, {v, f[0], f[1], f[2]});
                    take(std::array{v}, part(f[0]), distance);
                    take(f, part(v), distance);
                }
        for (const Edge& a : mesh_.edges)
            for (const Edge& b : mesh_.edges)
                if (part(a[0]) != part(b[0]) && may_meet(a[0], b[0]))
                    take(a, part(b[0]), at_rest(StencilKind::edge_edge, {a[0], a[1], b[0], b[1]}));
        for (const auto& [key, distance] : own)
            hand_on(key, distance);
    }

    /// To all primitives that contain the key's.
    void hand_on(const Key& key, double distance) {
        const auto take_for = [&](const auto& corners) {
            const std::set<int> outer(corners.begin(), corners.end());
            if (!std::includes(outer.begin(), outer.end(), key.first.begin(), key.first.end()))
                return;
            double& least = clearances_.try_emplace({outer, key.second}, distance).first->second;
            least = std::min(least, distance);
        };
        for (const int v : mesh_.vertices)
            take_for(std::array{v});
        std::for_each(mesh_.edges.begin(), mesh_.edges.end(), take_for);
        std::for_each(mesh_.faces.begin(), mesh_.faces.end(), take_for);
    }

    double clearance(const std::set<int>& corners, int other_part) const {
        const auto found = clearances_.find({corners, other_part});
        return found == clearances_.end() ? std::numeric_limits<double>::infinity() : found->second;
    }

    Place two_primitives(StencilKind kind, const std::array<int, 4>& v, const std::set<int>& a,
                         const std::set<int>& b) const {
        const bool same_part = part(v[0]) == part(v[3]);
        const double rest = same_part ? at_rest(kind, v) : std::min(clearance(a, part(v[3])), clearance(b, part(v[0])));
        Place place;
        place.kind = kind;
        place.vertices = v;
        place.range = pair_range(options_, same_part, rest);
        place.counts_as_gap = !same_part || rest >= options_.reach();
        return place;
    }

    Place point_and_face(int v, int f) const {
        const auto& [a, b, c] = face(f);
        Place place = two_primitives(StencilKind::point_triangle, {v, a, b, c}, {v}, {a, b, c});
        double largest = 0;
        for (const int w : mesh_.vertices)
            if (part(w) == part(a))
                largest = std::max(largest, mesh_.vertex_area[static_cast<std::size_t>(w)]);
        place.area = 0.35 * std::min(mesh_.vertex_area[static_cast<std::size_t>(v)], largest);
        return place;
    }

    Place two_edges(int i, int j) const {
        const Edge &a = edge(i), &b = edge(j);
        Place place = two_primitives(StencilKind::edge_edge, {a[0], a[1], b[0], b[1]}, {a[0], a[1]}, {b[0], b[1]});
        place.area =
            0.15 * std::min(mesh_.edge_area[static_cast<std::size_t>(i)], mesh_.edge_area[static_cast<std::size_t>(j)]);
        for (std::size_t end = 0; end < 4; ++end) {
            const Edge& other = end < 2 ? b : a;
            for (const Face& f : mesh_.faces) {
                const std::set<int> corners(f.begin(), f.end());
                if (corners.contains(other[0]) && corners.contains(other[1]) && !corners.contains(place.vertices[end]))
                    place.ends.insert(static_cast<int>(end));
            }
        }
        return place;
    }

    /// Faces, less edges for each face but one, plus vertices as often as that makes up for. Those at a face out of
    /// reach are out of reach too.
    template <typename Visit>
    void visit_point(int v, const Positions& x, const Visit& call) const {
        struct Counted {
            int faces = 0, inner_edges = 0;
            Place place;
        };
        std::map<std::vector<int>, Counted> edges, vertices;
        const auto count_face = [&](Counted& counted, const Place& place) {
            if (counted.faces++ == 0)
                counted.place = place;
            PairRange& range = counted.place.range;
            range.least = std::min(range.least, place.range.least);
            range.activation = std::min(range.activation, place.range.activation);
            counted.place.counts_as_gap = false;
        };
        for (int f = 0; f < size(mesh_.faces); ++f) {
            const Face& corners = face(f);
            if (!is_near(x, StencilKind::point_triangle, {v, corners[0], corners[1], corners[2]}) ||
                std::find(corners.begin(), corners.end(), v) != corners.end() || !may_meet(v, corners[0]))
                continue;
            const Place place = point_and_face(v, f);
            call(place);
            for (std::size_t k = 0; k < 3; ++k) {
                const int a = std::min(corners[k], corners[(k + 1) % 3]),
                          b = std::max(corners[k], corners[(k + 1) % 3]);
                count_face(edges[{a, b}], place);
                count_face(vertices[{corners[k]}], place);
            }
        }
        for (auto& [corners, counted] : edges)
            if (counted.faces >= 2) {
                for (const int w : corners)
                    vertices[{w}].inner_edges += counted.faces - 1;
                counted.place.vertices = {v, corners[0], corners[1], corners[1]};
                counted.place.count = 1 - counted.faces;
                call(counted.place);
            }
        for (auto& [corners, counted] : vertices) {
            counted.place.vertices = {v, corners[0], corners[0], corners[0]};
            counted.place.count = 1 - counted.faces + counted.inner_edges;
            if (counted.place.count != 0)
                call(counted.place);
        }
    }

    const CollisionMesh& mesh_;
    ContactOptions options_;
    std::map<Key, double> clearances_;
};

/// The mollifier of two edges at x, 1 for a point.
inline double reference_mollifier(const Place& place, const Stencil& x) {
    const double squared = std::pow(reference_distance(place.kind, x), 2);
    double product = 1;
    for (const int end : place.ends) {
        Stencil alone = x;
        alone.col(end < 2 ? 1 - end : 5 - end) = x.col(end); // an edge of no length
        const double ratio = squared / std::pow(reference_distance(place.kind, alone), 2);
        const double q = std::clamp((ratio - 0.25) / 0.75, 0.0, 1.0);
        product *= 1 - q * q * q;
    }
    return product;
}

/// J.
inline double reference_energy(const Place& place, const Stencil& x, const ContactOptions& options) {
    const double distance = reference_distance(place.kind, x);
    if (distance >= place.range.activation)
        return 0;
    const double least = place.range.least, activation = place.range.activation;
    const double share = (distance * distance - least * least) / (activation * activation - least * least);
    return place.count * place.area * options.stiffness * (activation - least) * reference_mollifier(place, x) *
           barrier(share).value;
}

} // namespace plisse
