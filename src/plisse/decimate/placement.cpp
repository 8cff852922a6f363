#include <plisse/decimate/placement.h>

#include <Eigen/Geometry>

#include <cmath>

#include <plisse/base/random.h>
#include <plisse/decimate/patch.h>
#include <plisse/mesh/connectivity.h>
#include <plisse/spatial/box.h>

namespace plisse {

Placer::Placer(const Positions& rest, std::span<const Face> faces, const std::vector<VertexState>& vertices,
               const DecimationOptions& options)
    : options_(options), quadrics_(vertices.size()) {
    scale_to(rest, faces, vertices);
    add_faces(rest, faces, vertices);
    add_curves(rest, faces, vertices);
}

void Placer::scale_to(const Positions& rest, std::span<const Face> faces, const std::vector<VertexState>& vertices) {
    Box box;
    double edges = 0;
    int count = 0;
    for (const Face& face : faces) {
        if (vertices[face[0]].group < 0)
            continue;
        for (std::size_t c = 0; c < 3; ++c) {
            box.include(rest.col(face[c]));
            edges += (rest.col(face[(c + 1) % 3]) - rest.col(face[c])).norm();
            ++count;
        }
    }
    if (count == 0 || !(edges > 0))
        return;
    center_ = box.center();
    scale_ = std::exp2(-std::round(std::log2(box.diagonal())));
    mean_edge_ = scale_ * edges / count;
}

void Placer::add_faces(const Positions& rest, std::span<const Face> faces, const std::vector<VertexState>& vertices) {
    for (const Face& face : faces) {
        if (vertices[face[0]].group < 0)
            continue;
        const Vec3 p = inward(rest.col(face[0])), q = inward(rest.col(face[1])), r = inward(rest.col(face[2]));
        const Vec3 normal = (q - p).cross(r - p);
        const double twice_area = normal.norm();
        if (!(twice_area > 0))
            continue;
        const Vec3 unit = normal / twice_area, centroid = (p + q + r) / 3;
        const double weight = 0.5 * twice_area / (mean_edge_ * mean_edge_);
        const Quadric uncertain = probabilistic_plane_quadric(unit, centroid, weight, options_.normal_sigma,
                                                              options_.point_sigma * mean_edge_);
        const Quadric exact = plane_quadric(unit, centroid, weight);
        for (int v : face) {
            quadrics_[v].cost += uncertain;
            quadrics_[v].exact += exact;
        }
    }
}

void Placer::add_curves(const Positions& rest, std::span<const Face> faces, const std::vector<VertexState>& vertices) {
    const Connectivity connectivity(static_cast<int>(quadrics_.size()), faces);
    for (int e = 0; e < connectivity.edge_count(); ++e) {
        const Edge& edge = connectivity.edges()[e];
        if (!connectivity.is_curve_edge(e) || vertices[edge[0]].group < 0)
            continue;
        const Vec3 p = inward(rest.col(edge[0])), q = inward(rest.col(edge[1]));
        for (int f : connectivity.edge_faces(e)) {
            const Face& face = faces[f];
            const Vec3 normal = face_shape(rest.col(face[0]), rest.col(face[1]), rest.col(face[2])).normal;
            const Vec3 across = (q - p).cross(normal);
            const double length = across.norm();
            if (!(length > 0))
                continue;
            const Quadric plane =
                plane_quadric(across / length, 0.5 * (p + q), (q - p).squaredNorm() / (mean_edge_ * mean_edge_));
            for (int v : edge) {
                quadrics_[v].cost += plane;
                quadrics_[v].exact += plane;
            }
        }
    }
}

void Placer::merge(const Edge& edge) {
    quadrics_.push_back(
        {quadrics_[edge[0]].cost + quadrics_[edge[1]].cost, quadrics_[edge[0]].exact + quadrics_[edge[1]].exact});
}

/// The end that must keep its place; none when both may move. The caller knows that one can.
Alias Placer::kept_end(const Edge& edge, const Positions& rest, const VertexState& i, const VertexState& j) const {
    if (i.pinned() != j.pinned())
        return i.pinned() ? Alias::i : Alias::j;
    if (i.pinned()) {
        if (i.rank() != j.rank())
            return i.rank() > j.rank() ? Alias::i : Alias::j;
        const Quadric sum = quadrics_[edge[0]].cost + quadrics_[edge[1]].cost;
        return sum(inward(rest.col(edge[0]))) <= sum(inward(rest.col(edge[1]))) ? Alias::i : Alias::j;
    }
    if (i.on_curve != j.on_curve)
        return i.on_curve ? Alias::i : Alias::j;
    return Alias::none;
}

std::optional<Placement> Placer::place(const Edge& edge, bool is_curve_edge, const Positions& rest,
                                       const std::vector<VertexState>& vertices) const {
    const VertexState &i = vertices[edge[0]], &j = vertices[edge[1]];
    if (i.group < 0 || i.locked || j.locked || (i.on_curve && j.on_curve && !is_curve_edge))
        return {};
    if (i.pinned() && j.pinned() && (i.label != j.label || (i.corner && j.corner)))
        return {};
    Placement placement;
    placement.alias = kept_end(edge, rest, i, j);
    const Quadric cost = quadrics_[edge[0]].cost + quadrics_[edge[1]].cost;
    if (placement.alias == Alias::none) {
        placement.position = outward(is_curve_edge ? curve_minimiser(edge, rest) : cost.minimiser());
        if (!placement.position.allFinite())
            placement.position = 0.5 * (rest.col(edge[0]) + rest.col(edge[1]));
    } else {
        const bool first = placement.alias == Alias::i;
        if ((first ? j : i).on_curve && !(first ? i : j).on_curve)
            return {};
        placement.position = rest.col(edge[first ? 0 : 1]);
    }
    placement.cost = cost(inward(placement.position)) * jitter(edge);
    return placement;
}

/// Exact planes alone leave the place along a straight curve open: a weak pull to both ends settles it.
Vec3 Placer::curve_minimiser(const Edge& edge, const Positions& rest) const {
    Quadric q = quadrics_[edge[0]].exact + quadrics_[edge[1]].exact;
    const double pull = 1e-3 * q.a.trace() / 3;
    q.a.diagonal().array() += 2 * pull;
    q.b += pull * (inward(rest.col(edge[0])) + inward(rest.col(edge[1])));
    return q.minimiser();
}

double Placer::jitter(const Edge& edge) const {
    const auto hash = static_cast<std::uint64_t>(edge[0]) << 32 | static_cast<std::uint64_t>(edge[1]);
    return 1 + options_.cost_jitter * Random(options_.seed ^ (hash * 0xd6e8feb86659fd93ULL)).uniform();
}

} // namespace plisse
