#include <plisse/contact/active_set.h>

#include <cmath>
#include <limits>

#include <plisse/geometry/mollifier.h>

namespace plisse {

namespace {

constexpr int chunk_size = 512;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two parallel sheets of like triangles meet, per area A, in 2 A / vertex area point-triangle pairs, from both sides,
/// and in about 2.4 A / edge area crossing edges: with these shares the pressure between them comes to 1.1 times that
/// of one barrier per area, plus what edges and corners beside each other add (measured: 1.3 to 1.4 in all where the
/// contact distance is a tenth of the edges, 2 where it is a third), on fine meshes as on coarse ones.
constexpr double point_triangle_share = 0.5, edge_edge_share = 0.25;

} // namespace

ActiveSet::ActiveSet(const CollisionMesh& mesh, const ContactOptions& options) : mesh_(mesh), options_(options) {
    edge_length_squared_.reserve(mesh.edges.size());
    for (const Edge& edge : mesh.edges)
        edge_length_squared_.push_back((mesh.rest.col(edge[1]) - mesh.rest.col(edge[0])).squaredNorm());
}

void ActiveSet::find(const Candidates& candidates, const Positions& x) {
    candidates.find_drift(x, x, drift_);
    const int first_count = candidates.size(StencilKind::point_triangle);
    const int second_count = candidates.size(StencilKind::edge_edge);
    const int first_chunks = chunk_count(first_count, chunk_size);
    const int chunks = first_chunks + chunk_count(second_count, chunk_size);
    chunks_.resize(std::max(chunks_.size(), static_cast<std::size_t>(chunks)));
    parallel_for(chunks, 1, [&](int c) {
        const bool first = c < first_chunks;
        const int begin = (first ? c : c - first_chunks) * chunk_size;
        const int end = std::min(begin + chunk_size, first ? first_count : second_count);
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
    chunk.energy = 0;
    chunk.least_gap = infinity;
    chunk.least_thickness_share = infinity;
    for (int i = begin; i < end; ++i) {
        const double least_distance = candidates.least_distance(kind, i, drift_);
        if (least_distance >= options_.reach())
            continue;
        const auto vertices = candidates.vertices(kind, i);
        const double rest_distance = candidates.rest_distance(kind, i);
        const PairRange range = pair_range(options_, same_part(vertices), rest_distance);
        const bool counts_as_gap = !same_part(vertices) || rest_distance >= options_.reach();
        const double farthest = counts_as_gap ? range.thickness + options_.distance : range.activation;
        if (least_distance >= farthest)
            continue;
        const Stencil stencil = gather(x, vertices);
        if (squared_sweep_distance(kind, stencil, stencil) >= farthest * farthest)
            continue;
        const Separation separation = separate(kind, stencil);
        if (separation.squared_distance >= farthest * farthest)
            continue;
        const double distance = std::sqrt(separation.squared_distance);
        if (counts_as_gap)
            chunk.least_gap = std::min(chunk.least_gap, distance - range.thickness);
        if (range.thickness > 0)
            chunk.least_thickness_share = std::min(chunk.least_thickness_share, distance / range.thickness);
        if (distance >= range.activation)
            continue;
        const std::array<int, 2> primitives = candidates.primitives(kind, i);
        const PairParameters pair = parameters(kind, primitives, range);
        chunk.energy += pair_energy(pair, separation, stencil);
        chunk.pairs.push_back({kind, primitives, vertices, pair, separation});
    }
}

PairRange ActiveSet::range(StencilKind kind, int candidate, const Candidates& candidates) const {
    return pair_range(options_, same_part(candidates.vertices(kind, candidate)),
                      candidates.rest_distance(kind, candidate));
}

PairParameters ActiveSet::parameters(StencilKind kind, const std::array<int, 2>& primitives,
                                     const PairRange& range) const {
    const auto first = static_cast<std::size_t>(primitives[0]), second = static_cast<std::size_t>(primitives[1]);
    PairParameters pair;
    pair.least_squared = range.least * range.least;
    pair.activation_squared = range.activation * range.activation;
    double area = 0;
    if (kind == StencilKind::point_triangle) {
        area = point_triangle_share * std::min(mesh_.vertex_area[first], mesh_.face_area[second]);
    } else {
        area = edge_edge_share * std::min(mesh_.edge_area[first], mesh_.edge_area[second]);
        pair.mollifier_threshold =
            mollifier_threshold_factor * edge_length_squared_[first] * edge_length_squared_[second];
    }
    pair.scale = area * options_.stiffness * (range.activation - range.least);
    return pair;
}

} // namespace plisse
