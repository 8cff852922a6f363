#include <plisse/contact/active_set.h>

#include <cmath>
#include <limits>

namespace plisse {

namespace {

constexpr int chunk_size = 512;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Between two parallel sheets of like triangles the points weigh twice their sheets' area A, from both sides, and
/// there are about 2.4 A / edge area crossing edges: with these shares the pressure comes to that of one barrier per
/// area.
constexpr double point_share = 0.35, edge_share = 0.15;

/// Candidates of one point follow each other: moves on from `candidate` to the first of its point, or to the end.
int first_of_point(const Candidates& candidates, int candidate) {
    constexpr auto kind = StencilKind::point_triangle;
    while (candidate > 0 && candidate < candidates.size(kind) &&
           candidates.primitives(kind, candidate)[0] == candidates.primitives(kind, candidate - 1)[0])
        ++candidate;
    return candidate;
}

PairParameters parameters(const PairRange& range, double stiffness) {
    PairParameters pair;
    pair.least_squared = range.least * range.least;
    pair.activation_squared = range.activation * range.activation;
    pair.scale = stiffness * (range.activation - range.least);
    return pair;
}

} // namespace

ActiveSet::ActiveSet(const CollisionMesh& mesh, const ContactOptions& options)
    : mesh_(mesh), options_(options), clearances_(mesh, 2 * options.reach()) {}

void ActiveSet::find(const Candidates& candidates, const Positions& x) {
    candidates.find_drift(x, x, drift_);
    const int first_count = candidates.size(StencilKind::point_triangle);
    const int second_count = candidates.size(StencilKind::edge_edge);
    const int first_chunks = chunk_count(first_count, chunk_size);
    const int chunks = first_chunks + chunk_count(second_count, chunk_size);
    chunks_.resize(std::max(chunks_.size(), static_cast<std::size_t>(chunks)));
    parallel_for(chunks, 1, [&](int c) {
        const bool first = c < first_chunks;
        int begin = (first ? c : c - first_chunks) * chunk_size;
        int end = std::min(begin + chunk_size, first ? first_count : second_count);
        if (first) {
            begin = first_of_point(candidates, begin);
            end = first_of_point(candidates, end);
        }
        find_chunk(candidates, first ? StencilKind::point_triangle : StencilKind::edge_edge, begin, end, x,
                   chunks_[static_cast<std::size_t>(c)]);
    });
    pairs_.clear();
    energy_ = 0;
    least_gap_ = infinity;
    least_thickness_share_ = infinity;
    for (int c = 0; c < chunks; ++c) {
        const Chunk& chunk = chunks_[static_cast<std::size_t>(c)];
        pairs_.insert(pairs_.end(), chunk.pairs.begin(), chunk.pairs.end());
        energy_ += chunk.energy;
        least_gap_ = std::min(least_gap_, chunk.least_gap);
        least_thickness_share_ = std::min(least_thickness_share_, chunk.least_thickness_share);
    }
}

void ActiveSet::find_chunk(const Candidates& candidates, StencilKind kind, int begin, int end, const Positions& x,
                           Chunk& chunk) const {
    chunk.pairs.clear();
    chunk.near.clear();
    chunk.energy = 0;
    chunk.least_gap = infinity;
    chunk.least_thickness_share = infinity;
    for (int i = begin; i < end; ++i) {
        const std::optional<NearPair> pair = look_at(candidates, kind, i, x, chunk);
        if (!pair)
            continue;
        const auto vertices = candidates.vertices(kind, i);
        const auto primitives = candidates.primitives(kind, i);
        if (kind == StencilKind::edge_edge) {
            add_edges(primitives, vertices, *pair, x, chunk);
            continue;
        }
        if (!chunk.near.empty() && chunk.near.front().vertices[0] != primitives[0])
            add_places(x, chunk);
        chunk.near.push_back({primitives[1], vertices, pair->range, pair->separation});
    }
    add_places(x, chunk);
}

std::uint8_t ActiveSet::repelling_ends(const std::array<int, 2>& edges, const std::array<int, 4>& vertices) const {
    std::uint8_t ends = 0;
    for (std::size_t i = 0; i < 4; ++i)
        for (const int face : mesh_.connectivity.edge_faces(edges[i < 2 ? 1 : 0]))
            if (!mesh_.has_corner(face, vertices[i]))
                ends |= static_cast<std::uint8_t>(1U << i);
    return ends;
}

std::optional<Separation> ActiveSet::separate_unless_seen(const Candidates& candidates, StencilKind kind, int candidate,
                                                          const Stencil& stencil) const {
    if (kind == StencilKind::point_triangle)
        return separate_point_triangle(stencil);
    if (const auto facing = separate_facing_edges(stencil))
        return facing;
    const std::uint8_t ends =
        repelling_ends(candidates.primitives(kind, candidate), candidates.vertices(kind, candidate));
    if (ends == 0b1111)
        return std::nullopt;
    const Separation separation = separate_edges(stencil);
    for (int i = 0; i < 4; ++i)
        if ((ends >> i & 1) != 0 && squared_distance_end(stencil, i) <= separation.squared_distance)
            return std::nullopt;
    return separation;
}

std::optional<ActiveSet::NearPair> ActiveSet::look_at(const Candidates& candidates, StencilKind kind, int candidate,
                                                      const Positions& x, Chunk& chunk) const {
    const double reach = options_.reach();
    if (candidates.least_distance(kind, candidate, drift_) >= reach)
        return std::nullopt;
    const auto vertices = candidates.vertices(kind, candidate);
    const Stencil stencil = gather(x, vertices);
    if (squared_sweep_distance(kind, stencil, stencil) >= reach * reach)
        return std::nullopt;
    const std::optional<Separation> separation = separate_unless_seen(candidates, kind, candidate, stencil);
    if (!separation || separation->squared_distance >= reach * reach)
        return std::nullopt;
    const double distance = std::sqrt(separation->squared_distance);
    const double apart_at_rest = rest_distance(candidates, kind, candidate);
    const PairRange range = pair_range(options_, same_part(vertices), apart_at_rest);
    const double gap = distance - range.thickness;
    const bool counts_as_gap = !same_part(vertices) || apart_at_rest >= reach;
    if (counts_as_gap && gap < options_.distance)
        chunk.least_gap = std::min(chunk.least_gap, gap);
    if (range.thickness > 0)
        chunk.least_thickness_share = std::min(chunk.least_thickness_share, distance / range.thickness);
    if (distance >= range.activation)
        return std::nullopt;
    return NearPair{range, *separation};
}

void ActiveSet::add(const ActivePair& pair, const Positions& x, Chunk& chunk) {
    chunk.energy += pair_energy(pair.parameters, pair.separation, gather(x, pair.vertices));
    chunk.pairs.push_back(pair);
}

void ActiveSet::add_places(const Positions& x, Chunk& chunk) const {
    if (chunk.near.empty())
        return;
    find_nearby_places(mesh_, x, chunk.near, chunk.places);
    const int point = chunk.near.front().vertices[0];
    for (const NearPlace& place : chunk.places) {
        const auto part = static_cast<std::size_t>(mesh_.part[static_cast<std::size_t>(place.vertices[3])]);
        const double area =
            std::min(mesh_.vertex_area[static_cast<std::size_t>(point)], mesh_.largest_vertex_area[part]);
        const double stiffness = place.count * point_share * area * options_.stiffness;
        add({StencilKind::point_triangle,
             {point, place.face},
             place.vertices,
             parameters(place.range, stiffness),
             place.separation},
            x, chunk);
    }
    chunk.near.clear();
}

void ActiveSet::add_edges(const std::array<int, 2>& edges, const std::array<int, 4>& vertices, const NearPair& pair,
                          const Positions& x, Chunk& chunk) const {
    const double area = std::min(mesh_.edge_area[static_cast<std::size_t>(edges[0])],
                                 mesh_.edge_area[static_cast<std::size_t>(edges[1])]);
    PairParameters weighed = parameters(pair.range, edge_share * area * options_.stiffness);
    weighed.ends = repelling_ends(edges, vertices);
    add({StencilKind::edge_edge, edges, vertices, weighed, pair.separation}, x, chunk);
}

double ActiveSet::rest_distance(const Candidates& candidates, StencilKind kind, int candidate) const {
    if (same_part(candidates.vertices(kind, candidate)))
        return candidates.rest_distance(kind, candidate);
    return clearances_.between(kind, candidates.primitives(kind, candidate));
}

double ActiveSet::least_distance(StencilKind kind, int candidate, const Candidates& candidates) const {
    const bool one_part = same_part(candidates.vertices(kind, candidate));
    if (options_.thickness == 0 || (one_part && kind == StencilKind::edge_edge))
        return 0;
    return pair_range(options_, one_part, rest_distance(candidates, kind, candidate)).least;
}

} // namespace plisse
