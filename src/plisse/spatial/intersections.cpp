#include <plisse/spatial/intersections.h>

#include <algorithm>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <Eigen/Geometry>

#include <plisse/spatial/box_tree.h>

namespace plisse {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangle = std::array<Vec3, 3>;

/// Bounds the relative error of the few-term sums of products that the floating-point filters below take.
constexpr double filter_epsilon = 1e-14;

int sign_of_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto point = [](const Vec3& p) { return Kernel::Point_3(p.x(), p.y(), p.z()); };
    return static_cast<int>(CGAL::orientation(point(a), point(b), point(c), point(d)));
}

/// Turn a, b, c seen along one axis.
int sign_of_area(const Vec3& a, const Vec3& b, const Vec3& c, int axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto point = [&](const Vec3& p) { return Kernel::Point_2(p[u], p[v]); };
    return static_cast<int>(CGAL::orientation(point(a), point(b), point(c)));
}

/// An axis along which a, b, c are seen as a triangle; -1 when they lie on one line.
int seen_along(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (int axis = 0; axis < 3; ++axis)
        if (sign_of_area(a, b, c, axis) != 0)
            return axis;
    return -1;
}

bool before(const Vec3& a, const Vec3& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

/// Segments on one line: the lexicographic order is an order along it.
bool collinear_segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    const auto [first_low, first_high] = std::minmax(p, q, before);
    const auto [second_low, second_high] = std::minmax(r, s, before);
    return !before(first_high, second_low) && !before(second_high, first_low);
}

bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
    if (sign_of_volume(p, q, r, s) != 0)
        return false;
    for (int axis = 0; axis < 3; ++axis) {
        const int pqr = sign_of_area(p, q, r, axis), pqs = sign_of_area(p, q, s, axis);
        const int rsp = sign_of_area(r, s, p, axis), rsq = sign_of_area(r, s, q, axis);
        if (pqr != 0 || pqs != 0 || rsp != 0 || rsq != 0) // seen along this axis, the common plane is no line
            return pqr * pqs <= 0 && rsp * rsq <= 0;
    }
    return collinear_segments_meet(p, q, r, s);
}

bool point_in_coplanar_triangle(const Vec3& p, const Triangle& t, int axis) {
    const int s0 = sign_of_area(t[0], t[1], p, axis), s1 = sign_of_area(t[1], t[2], p, axis),
              s2 = sign_of_area(t[2], t[0], p, axis);
    return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

bool segment_meets_border(const Vec3& p, const Vec3& q, const Triangle& t) {
    return segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) || segments_meet(p, q, t[2], t[0]);
}

/// Closed segment against closed triangle; either may be degenerate.
bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Triangle& t) {
    const int side_p = sign_of_volume(t[0], t[1], t[2], p), side_q = sign_of_volume(t[0], t[1], t[2], q);
    if (side_p * side_q > 0)
        return false;
    if (side_p == 0 && side_q == 0) {
        const int axis = seen_along(t[0], t[1], t[2]);
        return (axis >= 0 && point_in_coplanar_triangle(p, t, axis)) || segment_meets_border(p, q, t);
    }
    const int s0 = sign_of_volume(p, q, t[0], t[1]), s1 = sign_of_volume(p, q, t[1], t[2]),
              s2 = sign_of_volume(p, q, t[2], t[0]);
    return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
}

/// Whether all corners of t are strictly on one side of the plane of u.
bool on_one_side(const Triangle& t, const Triangle& u) {
    const int side = sign_of_volume(u[0], u[1], u[2], t[0]);
    return side != 0 && sign_of_volume(u[0], u[1], u[2], t[1]) == side &&
           sign_of_volume(u[0], u[1], u[2], t[2]) == side;
}

/// Whether the plane through `apex` across `direction` has the points of `ahead` strictly before it and those of
/// `behind` strictly after it, for certain.
template <std::size_t Count>
bool surely_separates(const Vec3& direction, const Vec3& apex, const Vec3* ahead, const Vec3* behind) {
    const Vec3 size = direction.cwiseAbs();
    for (std::size_t i = 0; i < Count; ++i) {
        const Vec3 a = ahead[i] - apex, b = behind[i] - apex;
        if (!(a.dot(direction) > filter_epsilon * a.cwiseAbs().dot(size)) ||
            !(-b.dot(direction) > filter_epsilon * b.cwiseAbs().dot(size)))
            return false;
    }
    return true;
}

bool unconnected_intersect(const Triangle& a, const Triangle& b) {
    const Vec3 center_a = (a[0] + a[1] + a[2]) / 3, center_b = (b[0] + b[1] + b[2]) / 3;
    if (surely_separates<3>(center_a - center_b, 0.5 * (center_a + center_b), a.data(), b.data()))
        return false;
    if (on_one_side(a, b) || on_one_side(b, a))
        return false;
    for (std::size_t k = 0; k < 3; ++k)
        if (segment_meets_triangle(a[k], a[(k + 1) % 3], b) || segment_meets_triangle(b[k], b[(k + 1) % 3], a))
            return true;
    return false;
}

/// Corner 0 is shared. Along any ray from it that both triangles contain, one of them ends first, at its far edge.
bool vertex_neighbours_intersect(const Triangle& a, const Triangle& b) {
    const Vec3& v = a[0];
    const Vec3 toward_a = (a[1] - v).normalized() + (a[2] - v).normalized();
    const Vec3 toward_b = (b[1] - v).normalized() + (b[2] - v).normalized();
    if (surely_separates<2>(toward_a - toward_b, v, &a[1], &b[1]))
        return false;
    return segment_meets_triangle(a[1], a[2], b) || segment_meets_triangle(b[1], b[2], a);
}

/// Corners 0 and 1 are shared: the third corners must lie in one plane with them, on one side of the edge.
bool edge_neighbours_intersect(const Triangle& a, const Triangle& b) {
    const Vec3 edge = a[1] - a[0], to_a = a[2] - a[0], to_b = b[2] - a[0];
    const double bound = 8 * edge.squaredNorm() * to_a.norm() * to_b.norm();
    if (edge.cross(to_a).dot(edge.cross(to_b)) < -filter_epsilon * bound)
        return false;
    if (sign_of_volume(a[0], a[1], a[2], b[2]) != 0)
        return false;
    return segment_meets_triangle(a[2], a[2], b) || segment_meets_triangle(b[2], b[2], a) ||
           segments_meet(a[0], a[2], a[1], b[2]) || segments_meet(a[1], a[2], a[0], b[2]);
}

/// Brings shared vertices to the front of both faces, in the same order, and returns how many there are.
int align_shared(Face& a, Face& b) {
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = shared; j < 3; ++j)
            if (a[i] == b[j]) {
                std::swap(a[i], a[shared]);
                std::swap(b[j], b[shared]);
                ++shared;
                break;
            }
    return static_cast<int>(shared);
}

Triangle corners(const ConstPositions& positions, const Face& face) {
    return {positions.col(face[0]), positions.col(face[1]), positions.col(face[2])};
}

Box box_of(const Triangle& t) {
    Box box;
    for (const Vec3& corner : t)
        box.include(corner);
    return box;
}

} // namespace

bool faces_intersect(const ConstPositions& positions, const Face& a, const Face& b) {
    Face front_a = a, front_b = b;
    const int shared = align_shared(front_a, front_b);
    const Triangle corners_a = corners(positions, front_a), corners_b = corners(positions, front_b);
    switch (shared) {
    case 0:
        return box_of(corners_a).overlaps(box_of(corners_b)) && unconnected_intersect(corners_a, corners_b);
    case 1:
        return vertex_neighbours_intersect(corners_a, corners_b);
    case 2:
        return edge_neighbours_intersect(corners_a, corners_b);
    default:
        return true;
    }
}

std::vector<std::array<int, 2>> intersecting_pairs(const ConstPositions& positions, std::span<const Face> faces,
                                                   const std::function<bool(int, int)>& skip, int most) {
    std::vector<Box> boxes;
    boxes.reserve(faces.size());
    for (const Face& face : faces)
        boxes.push_back(box_of(corners(positions, face)));
    OverlapPairs found;
    found.find_within(
        BoxTree(boxes),
        [&](int i, int j) {
            return !(skip && skip(std::min(i, j), std::max(i, j))) &&
                   faces_intersect(positions, faces[static_cast<std::size_t>(i)], faces[static_cast<std::size_t>(j)]);
        },
        std::numeric_limits<std::size_t>::max());
    std::vector<std::array<int, 2>> pairs = found.pairs();
    for (auto& pair : pairs)
        if (pair[0] > pair[1])
            std::swap(pair[0], pair[1]);
    std::sort(pairs.begin(), pairs.end());
    if (pairs.size() > static_cast<std::size_t>(most))
        pairs.resize(static_cast<std::size_t>(most));
    return pairs;
}

} // namespace plisse
