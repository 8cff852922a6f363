#include <plisse/decimate/point_carrier.h>

#include <algorithm>
#include <limits>

namespace plisse {

namespace {

constexpr double least_weight = 1e-12; // less is round-off
constexpr double worst_round_off = -1e-9;

double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

Vec3 barycentric(const std::array<Vec2, 3>& corner, const Vec2& x) {
    const Vec2 p = corner[0] - x, q = corner[1] - x, r = corner[2] - x;
    return Vec3(cross(q, r), cross(r, p), cross(p, q)) / cross(corner[1] - corner[0], corner[2] - corner[0]);
}

struct Fit {
    const ChartTriangles::Triangle* triangle = nullptr;
    Vec3 weights = Vec3::Zero();
    double score = -std::numeric_limits<double>::infinity(); ///< smallest weight

    void offer(const ChartTriangles::Triangle& candidate, const Vec3& candidate_weights, double candidate_score) {
        if (candidate_score > score || triangle == nullptr) {
            triangle = &candidate;
            weights = candidate_weights;
            score = candidate_score;
        }
    }
};

Fit locate_inside(const std::vector<ChartTriangles::Triangle>& triangles, const Vec2& place) {
    Fit best;
    for (const auto& triangle : triangles) {
        const Vec3 weights = barycentric(triangle.corner, place);
        best.offer(triangle, weights, weights.minCoeff());
    }
    return best;
}

/// A boundary point is sought on boundary sides, its weight opposite the side being zero by definition.
Fit locate_on_boundary(const std::vector<ChartTriangles::Triangle>& triangles, const Vec2& place) {
    Fit best;
    for (const auto& triangle : triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            if (!triangle.boundary[c])
                continue;
            Vec3 weights = barycentric(triangle.corner, place);
            const double off = std::abs(weights[static_cast<Eigen::Index>(c)]);
            weights[static_cast<Eigen::Index>(c)] = 0;
            best.offer(triangle, weights, std::min(weights.minCoeff(), -off));
        }
    return best;
}

bool holds(const Face& face, int vertex) {
    return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

/// Lays out the triangles of one side of a collapse, and marks their sides on the boundary.
class Layout {
public:
    Layout(const Collapse& collapse, const Chart& chart, const DynamicFaces& faces,
           const std::vector<bool>& on_boundary)
        : collapse_(collapse), chart_(chart), faces_(faces), on_boundary_(on_boundary) {}

    void add(int face, const Face& corners) {
        ids_.push_back(face);
        corners_.push_back(corners);
    }

    void finish(std::vector<ChartTriangles::Triangle>& triangles) const {
        triangles.clear();
        for (std::size_t n = 0; n < ids_.size(); ++n) {
            auto& triangle = triangles.emplace_back();
            triangle.face = ids_[n];
            for (std::size_t c = 0; c < 3; ++c) {
                triangle.corner[c] = place(corners_[n][c]);
                triangle.boundary[c] = is_boundary(corners_[n][(c + 1) % 3], corners_[n][(c + 2) % 3]);
            }
        }
    }

private:
    Vec2 place(int vertex) const {
        if (vertex == collapse_.i)
            return Vec2(0, 0);
        if (vertex == collapse_.j)
            return Vec2(1, 0);
        if (vertex == collapse_.k)
            return chart_.k;
        const auto found = std::lower_bound(collapse_.ring.begin(), collapse_.ring.end(), vertex);
        return chart_.ring[static_cast<std::size_t>(found - collapse_.ring.begin())];
    }

    bool is_boundary(int a, int b) const {
        if (!on_boundary_[a] || !on_boundary_[b])
            return false;
        const auto is_center = [&](int v) { return v == collapse_.i || v == collapse_.j || v == collapse_.k; };
        if (!is_center(a) && !is_center(b))
            return faces_.is_boundary_edge(a, b);
        return std::count_if(corners_.begin(), corners_.end(),
                             [&](const Face& face) { return holds(face, a) && holds(face, b); }) == 1;
    }

    const Collapse& collapse_;
    const Chart& chart_;
    const DynamicFaces& faces_;
    const std::vector<bool>& on_boundary_;
    std::vector<int> ids_;
    std::vector<Face> corners_;
};

} // namespace

void ChartTriangles::lay_out(const Collapse& collapse, const Chart& chart, const DynamicFaces& faces,
                             const std::vector<bool>& on_boundary) {
    ends_on_boundary = {on_boundary[collapse.i], on_boundary[collapse.j]};
    merged_on_boundary = on_boundary[collapse.k];
    Layout old_side(collapse, chart, faces, on_boundary), new_side(collapse, chart, faces, on_boundary);
    for (std::size_t d = 0; d < collapse.dead_faces.size(); ++d)
        old_side.add(collapse.dead_faces[d], collapse.dead_corners[d]);
    const auto add_kept = [&](const std::vector<int>& kept, int from) {
        for (int f : kept) {
            Face corners = faces.face(f);
            old_side.add(f, corners);
            *std::find(corners.begin(), corners.end(), from) = collapse.k;
            new_side.add(f, corners);
        }
    };
    add_kept(collapse.faces_of_i, collapse.i);
    add_kept(collapse.faces_of_j, collapse.j);
    old_side.finish(before);
    new_side.finish(after);
}

PointCarrier::PointCarrier(std::span<const int> vertices, int vertex_id_count, int face_id_count)
    : point_at_vertex_(vertex_id_count, -1), first_in_face_(face_id_count, -1), next_in_face_(vertices.size(), -1),
      places_(vertices.size()), vertices_(vertices.begin(), vertices.end()) {
    for (std::size_t point = 0; point < vertices.size(); ++point)
        point_at_vertex_[vertices[point]] = static_cast<int>(point);
}

void PointCarrier::carry(const Collapse& collapse, const Chart& chart, const ChartTriangles& triangles) {
    moving_.clear();
    const auto [i_on_boundary, j_on_boundary] = triangles.ends_on_boundary;
    move_vertex_point(collapse.i, chart.alias == Alias::i ? collapse.k : -1, Vec2(0, 0), i_on_boundary);
    move_vertex_point(collapse.j, chart.alias == Alias::j ? collapse.k : -1, Vec2(1, 0), j_on_boundary);
    relocate(triangles.before, triangles.after);
}

void PointCarrier::carry_back(const Collapse& collapse, const Chart& chart, const ChartTriangles& triangles) {
    moving_.clear();
    const int heir = chart.alias == Alias::i ? collapse.i : chart.alias == Alias::j ? collapse.j : -1;
    move_vertex_point(collapse.k, heir, chart.k, triangles.merged_on_boundary);
    relocate(triangles.after, triangles.before);
}

void PointCarrier::relocate(const std::vector<ChartTriangles::Triangle>& from,
                            const std::vector<ChartTriangles::Triangle>& to) {
    for (const auto& triangle : from)
        lift(triangle);
    for (const Moving& moving : moving_)
        settle(moving, to);
    relocations_ += static_cast<long>(moving_.size());
}

/// heir: the vertex that lies where this one was; -1: none does, and the point becomes one of a face.
void PointCarrier::move_vertex_point(int vertex, int heir, const Vec2& place, bool on_boundary) {
    const int point = point_at_vertex_[vertex];
    if (point < 0)
        return;
    point_at_vertex_[vertex] = -1;
    if (heir >= 0) {
        point_at_vertex_[heir] = point;
        vertices_[point] = heir;
    } else {
        vertices_[point] = -1;
        moving_.push_back({point, place, on_boundary});
    }
}

void PointCarrier::lift(const ChartTriangles::Triangle& triangle) {
    int& first = first_in_face_[triangle.face];
    for (int point = first; point >= 0; point = next_in_face_[point]) {
        const Vec3& weights = places_[point].weights;
        bool on_boundary = false;
        for (std::size_t c = 0; c < 3; ++c)
            on_boundary = on_boundary || (triangle.boundary[c] && weights[static_cast<Eigen::Index>(c)] == 0);
        const Vec2 place =
            weights[0] * triangle.corner[0] + weights[1] * triangle.corner[1] + weights[2] * triangle.corner[2];
        moving_.push_back({point, place, on_boundary});
    }
    first = -1;
}

void PointCarrier::settle(const Moving& moving, const std::vector<ChartTriangles::Triangle>& triangles) {
    Fit fit = moving.on_boundary ? locate_on_boundary(triangles, moving.place) : locate_inside(triangles, moving.place);
    worst_ = std::min(worst_, fit.score);
    errors_ += fit.score < worst_round_off;
    for (double& weight : fit.weights)
        if (weight < least_weight)
            weight = 0;
    fit.weights /= fit.weights.sum();
    const int face = fit.triangle->face;
    places_[moving.point] = {face, fit.weights};
    next_in_face_[moving.point] = first_in_face_[face];
    first_in_face_[face] = moving.point;
}

Anchor PointCarrier::anchor(int point, const DynamicFaces& faces) const {
    const int vertex = vertices_[point];
    if (vertex < 0)
        return places_[point];
    if (!faces.has_vertex(vertex))
        return {};
    const int f = faces.vertex_faces(vertex).front();
    const Face& face = faces.face(f);
    Anchor anchor{f, Vec3::Zero()};
    anchor.weights[std::find(face.begin(), face.end(), vertex) - face.begin()] = 1;
    return anchor;
}

} // namespace plisse
