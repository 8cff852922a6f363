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

/// How far a vertex may stray from where, or from the way along which, pairs were last found. Measured on a twisted
/// cloth: more makes more candidates to go through in each iteration, less makes more searches.
double region_slack(const CollisionMesh& mesh, double reach) {
    double edge_length = 0;
    for (const Edge& edge : mesh.edges)
        edge_length += (mesh.rest.col(edge[0]) - mesh.rest.col(edge[1])).norm();
    edge_length /= std::max<double>(1, static_cast<double>(mesh.edges.size()));
    return std::max(0.5 * reach, 0.05 * edge_length);
}

/// Scalar by scalar: stencils have just been gathered in pieces, which wide loads would have to wait for.
template <int First>
double squared_sweep_gap(const Stencil& from, const Stencil& to) {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto low = [&](int i) { return std::min(from(axis, i), to(axis, i)); };
        const auto high = [&](int i) { return std::max(from(axis, i), to(axis, i)); };
        const double above = First == 1 ? low(0) - std::max({high(1), high(2), high(3)})
                                        : std::min(low(0), low(1)) - std::max(high(2), high(3));
        const double below = First == 1 ? std::min({low(1), low(2), low(3)}) - high(0)
                                        : std::min(low(2), low(3)) - std::max(high(0), high(1));
        const double gap = std::max({0.0, above, below});
        squared += gap * gap;
    }
    return squared;
}

/// A lower bound on the distance of two primitives, the first of `First` points: the room between two planes square to
/// the line that joins their centres.
template <int First>
double plane_gap(const Stencil& x) {
    const auto sum = [&](int axis, int begin, int end) {
        double total = 0;
        for (int i = begin; i < end; ++i)
            total += x(axis, i) - x(axis, 0);
        return total;
    };
    double normal[3], squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
        normal[axis] = sum(axis, 0, First) / First - sum(axis, First, 4) / (4 - First);
        squared += normal[axis] * normal[axis];
    }
    const auto height = [&](int i) {
        return normal[0] * (x(0, i) - x(0, 0)) + normal[1] * (x(1, i) - x(1, 0)) + normal[2] * (x(2, i) - x(2, 0));
    };
    const double low = First == 1 ? 0 : std::min(0.0, height(1));
    const double high = First == 1 ? std::max({height(1), height(2), height(3)}) : std::max(height(2), height(3));
    return (low - high) / std::sqrt(squared);
}

/// The distance, or a lower bound that is at least `cut`.
double distance_up_to(StencilKind kind, const Stencil& x, double cut) {
    const double box_squared = squared_sweep_distance(kind, x, x);
    if (box_squared >= cut * cut)
        return std::sqrt(box_squared);
    // Most pairs of neighbours are that far apart, but not along an axis.
    const double between_planes = kind == StencilKind::point_triangle ? plane_gap<1>(x) : plane_gap<2>(x);
    return between_planes >= cut ? between_planes : std::sqrt(squared_distance(kind, x));
}

} // namespace

double squared_sweep_distance(StencilKind kind, const Stencil& from, const Stencil& to) {
    return kind == StencilKind::point_triangle ? squared_sweep_gap<1>(from, to) : squared_sweep_gap<2>(from, to);
}

Candidates::Candidates(const CollisionMesh& mesh, double reach, bool self)
    : mesh_(mesh), reach_(reach), self_(self), slack_(region_slack(mesh, reach)), vertex_boxes_(mesh.vertices.size()),
      edge_boxes_(mesh.edges.size()), face_boxes_(mesh.faces.size()) {
    // Trees keep their shape, and parts move apart: shifted far from each other, no two parts share a leaf.
    const double shift = 4 * bounding_box(mesh.rest).diagonal();
    const auto shifted_box = [&](std::span<const int> vertices) {
        Box box;
        for (const int v : vertices)
            box.include(mesh.rest.col(v) + mesh.part[static_cast<std::size_t>(v)] * shift * Vec3::UnitX());
        return box;
    };
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        vertex_boxes_[v] = shifted_box(std::span(&mesh.vertices[v], 1));
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
        edge_boxes_[e] = shifted_box(mesh.edges[e]);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        face_boxes_[f] = shifted_box(mesh.faces[f]);
    vertex_tree_ = BoxTree(vertex_boxes_);
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
    measure(x);
}

double Candidates::find_along(const Positions& x, const Positions& d, double most) {
    std::size_t limit = 100 * mesh_.vertices.size();
    const auto fit = [&](double share) {
        set_regions(x, &d, share);
        return find_pairs(limit);
    };
    if (fit(most)) {
        measure(x);
        return most;
    }
    find_around(x);
    limit = std::max(limit, 3 * std::max(vertex_faces_.found.pairs().size(), edge_edges_.found.pairs().size()));
    double share = most / 2;
    while (!fit(share))
        share /= 2;
    measure(x);
    return share;
}

std::array<int, 4> Candidates::vertices(StencilKind kind, int i) const {
    return mesh_.stencil_vertices(kind, primitives(kind, i));
}

void Candidates::set_regions(const Positions& x, const Positions* d, double share) {
    regions_.resize(static_cast<std::size_t>(x.cols()));
    balls_.resize(regions_.size());
    parallel_for(static_cast<int>(mesh_.vertices.size()), 512, [&](int i) {
        const int v = mesh_.vertices[static_cast<std::size_t>(i)];
        Box box;
        box.include(x.col(v));
        if (d)
            box.include(x.col(v) + share * d->col(v));
        box = box.inflated(slack_);
        regions_[static_cast<std::size_t>(v)] = box;
        balls_[static_cast<std::size_t>(v)] = ball_around(box);
        vertex_boxes_[static_cast<std::size_t>(i)] = box.inflated(reach_);
    });
    parallel_for(static_cast<int>(mesh_.edges.size()), 512, [&](int i) {
        const auto e = static_cast<std::size_t>(i);
        edge_boxes_[e] = box_of(regions_, mesh_.edges[e]).inflated(0.5 * reach_);
    });
    parallel_for(static_cast<int>(mesh_.faces.size()), 512, [&](int i) {
        const auto f = static_cast<std::size_t>(i);
        face_boxes_[f] = box_of(regions_, mesh_.faces[f]);
    });
    vertex_tree_.refit(vertex_boxes_);
    edge_tree_.refit(edge_boxes_);
    face_tree_.refit(face_boxes_);
}

bool Candidates::may_meet(int vertex, int other) const {
    const int a = mesh_.part[static_cast<std::size_t>(vertex)], b = mesh_.part[static_cast<std::size_t>(other)];
    const bool obstacle_a = mesh_.obstacle[static_cast<std::size_t>(a)] != 0;
    return a == b ? self_ && !obstacle_a : !(obstacle_a && mesh_.obstacle[static_cast<std::size_t>(b)] != 0);
}

Candidates::Ball Candidates::ball_around(const Box& box) {
    const Vec3 center = box.center();
    const double rounding = 16 * std::numeric_limits<double>::epsilon() * center.lpNorm<Eigen::Infinity>();
    return {center, 0.5 * box.diagonal() + rounding};
}

template <int First>
bool Candidates::stay_apart(const std::array<int, 4>& vertices) const {
    const auto ball = [&](int i) -> const Ball& {
        return balls_[static_cast<std::size_t>(vertices[static_cast<std::size_t>(i)])];
    };
    Stencil centers;
    double first = 0, second = 0;
    for (int i = 0; i < 4; ++i) {
        centers.col(i) = ball(i).center;
        double& largest = i < First ? first : second;
        largest = std::max(largest, ball(i).radius);
    }
    return plane_gap<First>(centers) > reach_ + first + second;
}

bool Candidates::find_pairs(std::size_t most) {
    return vertex_faces_.found.find_between(
               vertex_tree_, face_tree_,
               [&](int i, int f) {
                   const int v = mesh_.vertices[static_cast<std::size_t>(i)];
                   const Face& face = mesh_.faces[static_cast<std::size_t>(f)];
                   return v != face[0] && v != face[1] && v != face[2] && may_meet(v, face[0]) &&
                          !stay_apart<1>({v, face[0], face[1], face[2]});
               },
               most) &&
           edge_edges_.found.find_within(
               edge_tree_,
               [&](int i, int j) {
                   const Edge &a = mesh_.edges[static_cast<std::size_t>(i)],
                              &b = mesh_.edges[static_cast<std::size_t>(j)];
                   return a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1] && may_meet(a[0], b[0]) &&
                          !stay_apart<2>({a[0], a[1], b[0], b[1]});
               },
               most);
}

void Candidates::measure(StencilKind kind, Pairs& pairs) const {
    // Further apart than `beyond`, the boxes' distance is as good: drift within the regions uses up no more than that.
    const double beyond = reach_ + 4 * slack_;
    pairs.distances.resize(pairs.found.pairs().size());
    parallel_for(size(kind), 512, [&](int i) {
        pairs.distances[static_cast<std::size_t>(i)] =
            distance_up_to(kind, gather(measured_at_, vertices(kind, i)), beyond);
    });
}

void Candidates::measure(const Positions& x) {
    measured_at_ = x;
    measure(StencilKind::point_triangle, vertex_faces_);
    measure(StencilKind::edge_edge, edge_edges_);
}

bool Candidates::have_drifted(const Positions& x) const {
    double drift = 0;
    for (const int v : mesh_.vertices)
        drift += (x.col(v) - measured_at_.col(v)).norm();
    return drift > slack_ * static_cast<double>(mesh_.vertices.size());
}

double Candidates::rest_distance(StencilKind kind, int i) const {
    const double far = 2 * reach_;
    return std::min(far, distance_up_to(kind, gather(mesh_.rest, vertices(kind, i)), far));
}

void Candidates::find_drift(const Positions& x, const Positions& y, Drift& drift) const {
    drift.of_vertex.assign(static_cast<std::size_t>(x.cols()), 0);
    drift.of_edge.resize(mesh_.edges.size());
    drift.of_face.resize(mesh_.faces.size());
    auto& moved = drift.of_vertex;
    const auto moved_by = [&](int v) { return moved[static_cast<std::size_t>(v)]; };
    parallel_for(static_cast<int>(mesh_.vertices.size()), 1024, [&](int i) {
        const int v = mesh_.vertices[static_cast<std::size_t>(i)];
        const double squared =
            std::max((x.col(v) - measured_at_.col(v)).squaredNorm(), (y.col(v) - measured_at_.col(v)).squaredNorm());
        const double rounding =
            8 * std::numeric_limits<double>::epsilon() * measured_at_.col(v).lpNorm<Eigen::Infinity>();
        moved[static_cast<std::size_t>(v)] = std::sqrt(squared) * (1 + 1e-14) + rounding;
    });
    parallel_for(static_cast<int>(mesh_.edges.size()), 1024, [&](int i) {
        const auto& [a, b] = mesh_.edges[static_cast<std::size_t>(i)];
        drift.of_edge[static_cast<std::size_t>(i)] = std::max(moved_by(a), moved_by(b));
    });
    parallel_for(static_cast<int>(mesh_.faces.size()), 1024, [&](int i) {
        const auto& [a, b, c] = mesh_.faces[static_cast<std::size_t>(i)];
        drift.of_face[static_cast<std::size_t>(i)] = std::max({moved_by(a), moved_by(b), moved_by(c)});
    });
}

} // namespace plisse
