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

using Triangles = std::vector<ChartTriangles::Triangle>;

bool may_hold(const ChartTriangles::Triangle& triangle, int sheet) {
    return sheet < 0 || triangle.sheet == sheet;
}

Fit locate_inside(const Triangles& triangles, const Vec2& place, int sheet) {
    Fit best;
    for (const auto& triangle : triangles) {
        if (!may_hold(triangle, sheet))
            continue;
        const Vec3 weights = barycentric(triangle.corner, place);
        best.offer(triangle, weights, weights.minCoeff());
    }
    return best;
}

/// A point of a curve is sought on sides on curves, its weight opposite the side being zero by definition.
Fit locate_on_curve(const Triangles& triangles, const Vec2& place, int sheet) {
    Fit best;
    for (const auto& triangle : triangles)
        for (std::size_t c = 0; c < 3; ++c) {
            if (!triangle.on_curve[c] || !may_hold(triangle, sheet))
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

/// The same place on the lowest face that has it.
Anchor on_lowest_face(const Anchor& anchor, const DynamicFaces& faces) {
    const Face& corners = faces.face(anchor.face);
    for (std::size_t c = 0; c < 3; ++c) {
        const int a = corners[(c + 1) % 3], b = corners[(c + 2) % 3];
        if (anchor.weights[static_cast<Eigen::Index>(c)] != 0 || faces.edge_face_count(a, b) <= 2)
            continue;
        for (int f : faces.vertex_faces(a)) {
            const Face& others = faces.face(f);
            if (!holds(others, b))
                continue;
            Anchor lowest{f, Vec3::Zero()};
            for (int v : {a, b})
                lowest.weights[std::find(others.begin(), others.end(), v) - others.begin()] =
                    anchor.weights[std::find(corners.begin(), corners.end(), v) - corners.begin()];
            return lowest;
        }
    }
    return anchor;
}

/// Lays out the triangles of one side of a collapse, and marks their sides on curves.
class Layout {
public:
    Layout(const Patch& patch, const Chart& chart, const DynamicFaces& faces, const std::vector<bool>& on_curve)
        : patch_(patch), chart_(chart), faces_(faces), on_curve_(on_curve) {}

    void add(int face, int sheet, const Face& corners) { items_.push_back({face, sheet, corners}); }

    void finish(Triangles& triangles) const {
        triangles.clear();
        for (const Item& item : items_) {
            if (item.sheet == Patch::at_rest)
                continue;
            auto& triangle = triangles.emplace_back();
            triangle.face = item.face;
            triangle.sheet = item.sheet;
            for (std::size_t c = 0; c < 3; ++c) {
                triangle.corner[c] = place(item.sheet, item.corners[c]);
                triangle.on_curve[c] = is_curve(item.corners[(c + 1) % 3], item.corners[(c + 2) % 3]);
            }
        }
    }

private:
    struct Item {
        int face, sheet;
        Face corners;
    };

    Vec2 place(int sheet, int vertex) const {
        if (vertex == patch_.i)
            return Vec2(0, 0);
        if (vertex == patch_.j)
            return Vec2(1, 0);
        if (vertex == patch_.k)
            return chart_.k;
        return chart_.ring[static_cast<std::size_t>(patch_.place(sheet, vertex))];
    }

    bool is_curve(int a, int b) const {
        if (!on_curve_[a] || !on_curve_[b])
            return false;
        const auto is_center = [&](int v) { return v == patch_.i || v == patch_.j || v == patch_.k; };
        if (!is_center(a) && !is_center(b))
            return faces_.is_curve_edge(a, b);
        return std::count_if(items_.begin(), items_.end(),
                             [&](const Item& item) { return holds(item.corners, a) && holds(item.corners, b); }) != 2;
    }

    const Patch& patch_;
    const Chart& chart_;
    const DynamicFaces& faces_;
    const std::vector<bool>& on_curve_;
    std::vector<Item> items_;
};

} // namespace

void ChartTriangles::lay_out(const Collapse& collapse, const Chart& chart, const DynamicFaces& faces,
                             const std::vector<bool>& on_curve) {
    ends_on_curve = {on_curve[collapse.i], on_curve[collapse.j]};
    merged_on_curve = on_curve[collapse.k];
    patch_.gather(faces, collapse.i, collapse.j, collapse.k);
    Layout old_side(patch_, chart, faces, on_curve), new_side(patch_, chart, faces, on_curve);
    std::size_t number = 0;
    for (const auto* list : {&patch_.dead_faces, &patch_.faces_of_i, &patch_.faces_of_j})
        for (int f : *list)
            old_side.add(f, patch_.sheets[number++], faces.face(f));
    for (std::size_t n = 0; n < patch_.after.size(); ++n)
        new_side.add(patch_.after_face(n), patch_.sheet_of_after(n), patch_.after[n]);
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
    const auto [i_on_curve, j_on_curve] = triangles.ends_on_curve;
    move_vertex_point(collapse.i, chart.alias == Alias::i ? collapse.k : -1, Vec2(0, 0), i_on_curve);
    move_vertex_point(collapse.j, chart.alias == Alias::j ? collapse.k : -1, Vec2(1, 0), j_on_curve);
    relocate(triangles.before, triangles.after);
}

void PointCarrier::carry_back(const Collapse& collapse, const Chart& chart, const ChartTriangles& triangles) {
    moving_.clear();
    const int heir = chart.alias == Alias::i ? collapse.i : chart.alias == Alias::j ? collapse.j : -1;
    move_vertex_point(collapse.k, heir, chart.k, triangles.merged_on_curve);
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
void PointCarrier::move_vertex_point(int vertex, int heir, const Vec2& place, bool on_curve) {
    const int point = point_at_vertex_[vertex];
    if (point < 0)
        return;
    point_at_vertex_[vertex] = -1;
    if (heir >= 0) {
        point_at_vertex_[heir] = point;
        vertices_[point] = heir;
    } else {
        vertices_[point] = -1;
        moving_.push_back({point, place, on_curve, Moving::any_sheet});
    }
}

void PointCarrier::lift(const ChartTriangles::Triangle& triangle) {
    int& first = first_in_face_[triangle.face];
    for (int point = first; point >= 0; point = next_in_face_[point]) {
        const Vec3& weights = places_[point].weights;
        bool on_curve = false;
        for (std::size_t c = 0; c < 3; ++c)
            on_curve = on_curve || (triangle.on_curve[c] && weights[static_cast<Eigen::Index>(c)] == 0);
        const Vec2 place =
            weights[0] * triangle.corner[0] + weights[1] * triangle.corner[1] + weights[2] * triangle.corner[2];
        moving_.push_back({point, place, on_curve, triangle.sheet});
    }
    first = -1;
}

void PointCarrier::settle(const Moving& moving, const std::vector<ChartTriangles::Triangle>& triangles) {
    Fit fit = moving.on_curve ? locate_on_curve(triangles, moving.place, moving.sheet)
                              : locate_inside(triangles, moving.place, moving.sheet);
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
        return on_lowest_face(places_[point], faces);
    if (!faces.has_vertex(vertex))
        return {};
    const int f = faces.vertex_faces(vertex).front();
    const Face& face = faces.face(f);
    Anchor anchor{f, Vec3::Zero()};
    anchor.weights[std::find(face.begin(), face.end(), vertex) - face.begin()] = 1;
    return anchor;
}

} // namespace plisse
