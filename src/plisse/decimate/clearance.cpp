#include <plisse/decimate/clearance.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <plisse/spatial/intersections.h>

namespace plisse {

namespace {

bool holds(const Face& face, int vertex) {
    return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

bool share_a_vertex(const Face& a, const Face& b) {
    return holds(a, b[0]) || holds(a, b[1]) || holds(a, b[2]);
}

Box box_of(const Triangle& triangle) {
    Box box;
    for (const Vec3& corner : triangle)
        box.include(corner);
    return box;
}

double perimeter(const Triangle& t) {
    return (t[1] - t[0]).norm() + (t[2] - t[1]).norm() + (t[0] - t[2]).norm();
}

} // namespace

Clearance::Clearance(const Surface& surface, double least_gap) : surface_(surface), least_gap_(least_gap) {
    for (int f = 0; f < surface_.faces.face_id_count(); ++f)
        faces_left_ += surface_.faces.has_face(f);
    build_grid();
}

void Clearance::build_grid() {
    std::vector<double> extents;
    const int ids = surface_.faces.face_id_count();
    for (int f = 0; f < ids; ++f)
        if (surface_.faces.has_face(f)) {
            const Box box = box_of(corners(surface_.faces.face(f)));
            extents.push_back((box.high - box.low).maxCoeff());
        }
    faces_at_build_ = faces_left_;
    if (extents.empty())
        return;
    const auto median = extents.begin() + static_cast<std::ptrdiff_t>(extents.size() / 2);
    std::nth_element(extents.begin(), median, extents.end());
    grid_.emplace(*median > 0 ? 2 * *median : 1.0, ids);
    for (int f = 0; f < ids; ++f)
        if (surface_.faces.has_face(f))
            grid_->insert(f, box_of(corners(surface_.faces.face(f))));
}

void Clearance::apply(const Patch& patch) {
    for (int f : patch.dead_faces)
        grid_->remove(f);
    for (std::size_t n = 0; n < patch.after.size(); ++n)
        grid_->update(patch.after_face(n), box_of(corners(patch.after[n])));
    faces_left_ -= static_cast<int>(patch.dead_faces.size());
    if (4 * faces_left_ < faces_at_build_) // faces have about twice the size: so should cells
        build_grid();
}

Clearance::Verdict Clearance::check(const Patch& patch) {
    if (merged_star_intersects(patch))
        return Verdict::intersection;
    for (int vertex : patch.ring)
        if (ring_star_intersects(patch, vertex))
            return Verdict::intersection;
    return check_unconnected(patch);
}

/// Faces of one sheet around a vertex that a projection maps one to one, because all turn the same way around it and
/// once at most, meet only where they should.
bool Clearance::star_is_graph(int vertex) const {
    constexpr double least_slope = 0.05, angle_margin = 0.01;
    Vec3 direction = Vec3::Zero();
    for (const StarFace& face : star_)
        direction += *face.normal;
    direction.normalize();
    const Vec3 center = surface_.rest.col(vertex);
    double turn = 0;
    for (const StarFace& face : star_) {
        if (!(face.normal->dot(direction) > least_slope))
            return false;
        const Face& corner = *face.face;
        const std::size_t c = corner[0] == vertex ? 0 : corner[1] == vertex ? 1 : 2;
        const Vec3 p = surface_.rest.col(corner[(c + 1) % 3]) - center;
        const Vec3 q = surface_.rest.col(corner[(c + 2) % 3]) - center;
        turn += std::atan2(p.cross(q).dot(direction), p.dot(q) - p.dot(direction) * q.dot(direction));
    }
    return turn < 2 * std::numbers::pi + angle_margin;
}

bool Clearance::merged_star_intersects(const Patch& patch) {
    star_.clear();
    for (std::size_t n = 0; n < patch.after.size(); ++n)
        star_.push_back({&patch.after[n], &patch.after_shapes[n].normal});
    const bool joint = surface_.vertices[patch.i].joint || surface_.vertices[patch.j].joint;
    if (!joint && star_is_graph(patch.k))
        return false;
    const auto before = [&](std::size_t n) -> const Face& { return surface_.faces.face(patch.after_face(n)); };
    for (std::size_t n = 0; n < patch.after.size(); ++n)
        for (std::size_t m = 0; m < n; ++m)
            if (faces_intersect(surface_.rest, patch.after[n], patch.after[m]) &&
                !faces_intersect(surface_.rest, before(n), before(m)))
                return true;
    return false;
}

bool Clearance::newly_intersect(const Patch& patch, std::size_t after, int other) const {
    const Face& face = surface_.faces.face(other);
    return faces_intersect(surface_.rest, patch.after[after], face) &&
           !faces_intersect(surface_.rest, surface_.faces.face(patch.after_face(after)), face);
}

bool Clearance::ring_star_intersects(const Patch& patch, int vertex) {
    const auto is_outside = [&](int f) {
        const Face& face = surface_.faces.face(f);
        return !holds(face, patch.i) && !holds(face, patch.j);
    };
    star_.clear();
    for (std::size_t n = 0; n < patch.after.size(); ++n)
        if (holds(patch.after[n], vertex))
            star_.push_back({&patch.after[n], &patch.after_shapes[n].normal});
    for (int f : surface_.faces.vertex_faces(vertex))
        if (is_outside(f))
            star_.push_back({&surface_.faces.face(f), &surface_.shapes[f].normal});
    const VertexState& state = surface_.vertices[vertex];
    if (!state.locked && !state.joint && star_is_graph(vertex))
        return false;
    for (int f : surface_.faces.vertex_faces(vertex))
        for (std::size_t n = 0; n < patch.after.size(); ++n)
            if (is_outside(f) && holds(patch.after[n], vertex) && newly_intersect(patch, n, f))
                return true;
    return false;
}

bool Clearance::both_obstacles(int vertex, int face) const {
    const auto is_obstacle = [&](int v) { return surface_.obstacle_parts[surface_.vertices[v].part]; };
    return is_obstacle(vertex) && is_obstacle(surface_.faces.face(face)[0]);
}

Clearance::Verdict Clearance::check_unconnected(const Patch& patch) {
    after_.clear();
    after_boxes_.clear();
    Box star_box;
    double edge_sum = 0;
    for (const Face& face : patch.after) {
        after_.push_back(corners(face));
        after_boxes_.push_back(box_of(after_.back()));
        star_box.include(after_boxes_.back());
        edge_sum += perimeter(after_.back());
    }
    const double gap = least_gap_ * edge_sum / static_cast<double>(3 * after_.size());
    for (Box& box : after_boxes_)
        box = box.inflated(gap);
    grid_->query(star_box.inflated(gap), others_);
    for (int other : others_) {
        const Face& face = surface_.faces.face(other);
        if (holds(face, patch.i) || holds(face, patch.j) || both_obstacles(patch.i, other))
            continue;
        for (std::size_t n = 0; n < after_.size(); ++n) {
            if (!after_boxes_[n].overlaps(grid_->box(other)) || share_a_vertex(patch.after[n], face))
                continue;
            const Verdict verdict = check_pair(patch, n, other, gap);
            if (verdict != Verdict::clear)
                return verdict;
        }
    }
    return Verdict::clear;
}

Clearance::Verdict Clearance::check_pair(const Patch& patch, std::size_t after, int other, double gap) const {
    const Triangle triangle = corners(surface_.faces.face(other));
    if (surely_apart(after_[after], patch.after_shapes[after].normal, triangle, surface_.shapes[other].normal, gap))
        return Verdict::clear;
    if (newly_intersect(patch, after, other))
        return Verdict::intersection;
    constexpr double nearer = 0.98; // squared; layers that stay parallel change by round-off
    const double distance_squared = triangle_distance_squared(after_[after], triangle);
    const bool too_near =
        distance_squared < gap * gap && distance_squared < nearer * distance_before_squared(patch, other);
    return too_near ? Verdict::gap : Verdict::clear;
}

double Clearance::distance_before_squared(const Patch& patch, int other) const {
    const Face& face = surface_.faces.face(other);
    double least = std::numeric_limits<double>::infinity();
    for (const auto* before : {&patch.dead_faces, &patch.faces_of_i, &patch.faces_of_j})
        for (int f : *before)
            if (!share_a_vertex(surface_.faces.face(f), face))
                least = std::min(least, triangle_distance_squared(corners(surface_.faces.face(f)), corners(face)));
    return least;
}

} // namespace plisse
