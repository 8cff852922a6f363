#include <plisse/contact/candidates.h>

#include <cmath>

namespace plisse {

namespace {

constexpr std::size_t unlimited = std::numeric_limits<std::size_t>::max();

Box box_of(const std::vector<Box>& regions, std::span<const int> vertices) {
    Box box;
    for (const int v : vertices)
        box.include(regions[static_cast<std::size_t>(v)]);
    return box;
}

/// How far a vertex may stray from where, or from the way along which, pairs were last found.
double region_slack(const CollisionMesh& mesh, double distance) {
    double edge_length = 0;
    for (const Edge& edge : mesh.edges)
        edge_length += (mesh.rest.col(edge[0]) - mesh.rest.col(edge[1])).norm();
    edge_length /= std::max<double>(1, static_cast<double>(mesh.edges.size()));
    return std::max(0.5 * distance, 0.1 * edge_length);
}

} // namespace

double squared_box_distance(StencilKind kind, const Stencil& x) {
    const int first = kind == StencilKind::point_triangle ? 1 : 2;
    const Vec3 low = x.leftCols(first).rowwise().minCoeff(), high = x.leftCols(first).rowwise().maxCoeff();
    const Vec3 other_low = x.rightCols(4 - first).rowwise().minCoeff();
    const Vec3 other_high = x.rightCols(4 - first).rowwise().maxCoeff();
    return (low - other_high).cwiseMax(other_low - high).cwiseMax(0.0).squaredNorm();
}

Candidates::Candidates(const CollisionMesh& mesh, double distance, bool self)
    : mesh_(mesh), distance_(distance), self_(self), slack_(region_slack(mesh, distance)),
      vertex_boxes_(mesh.vertices.size()), edge_boxes_(mesh.edges.size()), face_boxes_(mesh.faces.size()) {
    // Trees keep their shape, and parts move apart: shifted far from each other, no two parts share a leaf.
    const double shift = 4 * bounding_box(mesh.rest).diagonal();
    const auto shifted_box = [&](std::span<const int> vertices) {
        Box box;
        for (const int v : vertices)
            box.include(mesh.rest.col(v) + mesh.part[static_cast<std::size_t>(v)] * shift * Vec3::UnitX());
        return box;
    };
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
        edge_boxes_[e] = shifted_box(mesh.edges[e]);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        face_boxes_[f] = shifted_box(mesh.faces[f]);
    edge_tree_ = BoxTree(edge_boxes_);
    face_tree_ = BoxTree(face_boxes_);
}

bool Candidates::contain(const Positions& x) const {
    if (regions_.empty())
        return false;
    for (const int v : mesh_.vertices) {
        const Box& region = regions_[static_cast<std::size_t>(v)];
        if (!((region.low.array() <= x.col(v).array()).all() && (x.col(v).array() <= region.high.array()).all()))
            return false;
    }
    return true;
}

void Candidates::find_around(const Positions& x) {
    set_regions(x, nullptr, 0);
    find_pairs(unlimited);
}

double Candidates::find_along(const Positions& x, const Positions& d, double most) {
    std::size_t limit = 100 * mesh_.vertices.size();
    const auto fit = [&](double share) {
        set_regions(x, &d, share);
        return find_pairs(limit);
    };
    if (fit(most))
        return most;
    find_around(x);
    limit = std::max(limit, 3 * std::max(vertex_faces_.found.pairs().size(), edge_edges_.found.pairs().size()));
    double share = most / 2;
    while (!fit(share))
        share /= 2;
    return share;
}

std::array<int, 4> Candidates::vertices(StencilKind kind, int i) const {
    const auto [first, second] = primitives(kind, i);
    if (kind == StencilKind::point_triangle) {
        const Face& face = mesh_.faces[static_cast<std::size_t>(second)];
        return {first, face[0], face[1], face[2]};
    }
    const Edge &a = mesh_.edges[static_cast<std::size_t>(first)], &b = mesh_.edges[static_cast<std::size_t>(second)];
    return {a[0], a[1], b[0], b[1]};
}

void Candidates::set_regions(const Positions& x, const Positions* d, double share) {
    regions_.resize(static_cast<std::size_t>(x.cols()));
    parallel_for(static_cast<int>(mesh_.vertices.size()), 512, [&](int i) {
        const int v = mesh_.vertices[static_cast<std::size_t>(i)];
        Box box;
        box.include(x.col(v));
        if (d)
            box.include(x.col(v) + share * d->col(v));
        box = box.inflated(slack_);
        regions_[static_cast<std::size_t>(v)] = box;
        vertex_boxes_[static_cast<std::size_t>(i)] = box.inflated(distance_);
    });
    parallel_for(static_cast<int>(mesh_.edges.size()), 512, [&](int i) {
        const auto e = static_cast<std::size_t>(i);
        edge_boxes_[e] = box_of(regions_, mesh_.edges[e]).inflated(0.5 * distance_);
    });
    parallel_for(static_cast<int>(mesh_.faces.size()), 512, [&](int i) {
        const auto f = static_cast<std::size_t>(i);
        face_boxes_[f] = box_of(regions_, mesh_.faces[f]);
    });
    edge_tree_.refit(edge_boxes_);
    face_tree_.refit(face_boxes_);
}

bool Candidates::may_meet(int vertex, int other) const {
    const int a = mesh_.part[static_cast<std::size_t>(vertex)], b = mesh_.part[static_cast<std::size_t>(other)];
    const bool obstacle_a = mesh_.obstacle[static_cast<std::size_t>(a)] != 0;
    return a == b ? self_ && !obstacle_a : !(obstacle_a && mesh_.obstacle[static_cast<std::size_t>(b)] != 0);
}

bool Candidates::find_pairs(std::size_t most) {
    const bool complete =
        vertex_faces_.found.find_between(
            vertex_boxes_, face_tree_,
            [&](int i, int f) {
                const int v = mesh_.vertices[static_cast<std::size_t>(i)];
                const Face& face = mesh_.faces[static_cast<std::size_t>(f)];
                return v != face[0] && v != face[1] && v != face[2] && may_meet(v, face[0]);
            },
            most) &&
        edge_edges_.found.find_within(
            edge_tree_,
            [&](int i, int j) {
                const Edge &a = mesh_.edges[static_cast<std::size_t>(i)], &b = mesh_.edges[static_cast<std::size_t>(j)];
                return a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1] && may_meet(a[0], b[0]);
            },
            most);
    if (!complete)
        return false;
    find_rest_distances(StencilKind::point_triangle, vertex_faces_);
    find_rest_distances(StencilKind::edge_edge, edge_edges_);
    return true;
}

void Candidates::find_rest_distances(StencilKind kind, Pairs& pairs) const {
    const double far = 2 * distance_;
    pairs.rest_distances.resize(pairs.found.pairs().size());
    parallel_for(size(kind), 512, [&](int i) {
        const Stencil rest = gather(mesh_.rest, vertices(kind, i));
        double distance = far;
        if (squared_box_distance(kind, rest) < far * far)
            distance = std::min(far, std::sqrt(separate(kind, rest).squared_distance));
        pairs.rest_distances[static_cast<std::size_t>(i)] = distance;
    });
}

} // namespace plisse
