#include <plisse/geometry/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <Eigen/Geometry>

namespace plisse {

namespace {

/// Sines below this are noise: such edges count as parallel and such triangles as degenerate, and the nearest of their
/// borders is as near as the inside to within round-off.
constexpr double parallel_sine_squared = 1e-20;

/// A point of one primitive against an edge of the other; `side` is the sign of the edge's primitive in the offset.
struct Border {
    int point, start, end;
    double side;
};

/// Border k of a triangle starts at its corner k; border i of two edges has their point i.
constexpr std::array<Border, 3> triangle_borders = {{{0, 1, 2, -1}, {0, 2, 3, -1}, {0, 3, 1, -1}}};
constexpr std::array<Border, 4> edge_borders = {{{0, 2, 3, -1}, {1, 2, 3, -1}, {2, 0, 1, 1}, {3, 0, 1, 1}}};

std::uint8_t bit(int corner) {
    return static_cast<std::uint8_t>(1 << corner);
}

/// Points relative to the first one, so that a stencil far from the origin loses no digits.
Stencil relative(const Stencil& x) {
    return x.colwise() - x.col(0);
}

/// Fills in what follows from weights and slides. Rounding leaves parts of y * w along the tangents that are as large
/// as the offset itself when the primitives nearly touch, so they are taken off.
void complete(Separation& s, const Stencil& y) {
    s.tangents = y * s.slides;
    s.offset = y * s.weights;
    if (s.freedom == 1) {
        const Vec3 tangent = s.tangents.col(0);
        s.offset -= s.offset.dot(tangent) / tangent.squaredNorm() * tangent;
    } else if (s.freedom == 2) {
        const Vec3 normal = cross_square(s.tangents.col(0), s.tangents.col(1)).normalized();
        s.offset = s.offset.dot(normal) * normal;
    }
    s.squared_distance = s.offset.squaredNorm();
}

/// Parameter in [0, 1] of the edge's closest point.
double closest_parameter(const Vec3& p, const Vec3& start, const Vec3& end) {
    const Vec3 edge = end - start;
    const double along = edge.dot(p - start), length_squared = edge.squaredNorm();
    if (!(along > 0))
        return 0;
    return along < length_squared ? along / length_squared : 1;
}

Separation separate_border(const Stencil& y, const Border& border, double parameter) {
    Separation s;
    s.weights[border.point] = -border.side;
    s.weights[border.start] = border.side * (1 - parameter);
    s.weights[border.end] = border.side * parameter;
    s.corners = bit(border.point);
    if (parameter < 1)
        s.corners |= bit(border.start);
    if (parameter > 0)
        s.corners |= bit(border.end);
    if (parameter > 0 && parameter < 1) {
        s.freedom = 1;
        s.slides(border.start, 0) = -border.side;
        s.slides(border.end, 0) = border.side;
    }
    complete(s, y);
    return s;
}

Separation separate_border(const Stencil& y, const Border& border) {
    return separate_border(y, border, closest_parameter(y.col(border.point), y.col(border.start), y.col(border.end)));
}

/// The border whose closest points are nearest, and where.
struct NearestBorder {
    const Border* border = nullptr;
    double parameter = 0, squared_distance = 0;
};

NearestBorder find_nearest_border(const Stencil& y, std::span<const Border> borders) {
    NearestBorder nearest;
    for (const Border& border : borders) {
        const Vec3 p = y.col(border.point), start = y.col(border.start), end = y.col(border.end);
        const double parameter = closest_parameter(p, start, end);
        const double squared = (p - (1 - parameter) * start - parameter * end).squaredNorm();
        if (!nearest.border || squared < nearest.squared_distance)
            nearest = {&border, parameter, squared};
    }
    return nearest;
}

Separation separate_nearest_border(const Stencil& y, std::span<const Border> borders) {
    const NearestBorder nearest = find_nearest_border(y, borders);
    return separate_border(y, *nearest.border, nearest.parameter);
}

/// Where the insides of two primitives face each other, if they do: barycentric coordinates 1 and 2 of the foot in the
/// triangle, or the parameters of the closest points on two edges. `height_squared` is the squared distance there.
struct Facing {
    bool inside = false;
    double first = 0, second = 0, height_squared = 0;
};

Facing face_triangle(const Stencil& y) {
    const Vec3 e1 = y.col(2) - y.col(1), e2 = y.col(3) - y.col(1), to_point = -y.col(1);
    const Vec3 normal = cross_square(e1, e2);
    const double area_squared = normal.squaredNorm();
    if (!(area_squared > parallel_sine_squared * e1.squaredNorm() * e2.squaredNorm()))
        return {};
    const double b1 = to_point.cross(e2).dot(normal) / area_squared;
    const double b2 = e1.cross(to_point).dot(normal) / area_squared;
    const double height = to_point.dot(normal);
    return {b1 > 0 && b2 > 0 && b1 + b2 < 1, b1, b2, height * height / area_squared};
}

Facing face_edges(const Stencil& y) {
    const Vec3 u = y.col(1), v = y.col(3) - y.col(2), between = -y.col(2);
    const Vec3 normal = cross_square(u, v);
    const double area_squared = normal.squaredNorm();
    if (!(area_squared > parallel_sine_squared * u.squaredNorm() * v.squaredNorm()))
        return {};
    const double a = v.cross(between).dot(normal) / area_squared;
    const double b = u.cross(between).dot(normal) / area_squared;
    const double height = between.dot(normal);
    return {a > 0 && a < 1 && b > 0 && b < 1, a, b, height * height / area_squared};
}

} // namespace

Vec3 cross_square(const Vec3& u, const Vec3& v) {
    return u.cross(v - v.dot(u) / u.squaredNorm() * u);
}

Separation separate_points(const Vec3& p, const Vec3& q) {
    Separation s;
    s.weights << 1, -1, 0, 0;
    s.corners = bit(0) | bit(1);
    s.offset = p - q;
    s.squared_distance = s.offset.squaredNorm();
    return s;
}

Separation separate_point_edge(const Vec3& p, const Vec3& e0, const Vec3& e1) {
    Stencil y;
    y << Vec3::Zero(), e0 - p, e1 - p, Vec3::Zero();
    return separate_border(y, triangle_borders[0]);
}

Separation separate_point_triangle(const Stencil& x) {
    const Stencil y = relative(x);
    const Facing facing = face_triangle(y);
    if (!facing.inside)
        return separate_nearest_border(y, triangle_borders);
    Separation s;
    s.weights << 1, -(1 - facing.first - facing.second), -facing.first, -facing.second;
    s.slides.col(0) << 0, 1, -1, 0;
    s.slides.col(1) << 0, 1, 0, -1;
    s.freedom = 2;
    s.corners = 0b1111;
    complete(s, y);
    return s;
}

Separation separate_edges(const Stencil& x) {
    if (const auto facing = separate_facing_edges(x))
        return *facing;
    return separate_nearest_border(relative(x), edge_borders);
}

std::optional<Separation> separate_facing_edges(const Stencil& x) {
    const Stencil y = relative(x);
    const Facing facing = face_edges(y);
    if (!facing.inside)
        return std::nullopt;
    Separation s;
    s.weights << 1 - facing.first, facing.first, -(1 - facing.second), -facing.second;
    s.slides.col(0) << -1, 1, 0, 0;
    s.slides.col(1) << 0, 0, 1, -1;
    s.freedom = 2;
    s.corners = 0b1111;
    complete(s, y);
    return s;
}

Separation separate_from_border(const Stencil& x, int k) {
    return separate_border(relative(x), triangle_borders[static_cast<std::size_t>(k)]);
}

Separation separate_from_corner(const Stencil& x, int k) {
    return separate_border(relative(x), triangle_borders[static_cast<std::size_t>(k)], 0);
}

Separation separate_end(const Stencil& x, int i) {
    return separate_border(relative(x), edge_borders[static_cast<std::size_t>(i)]);
}

double squared_distance_point_triangle(const Stencil& x) {
    const Stencil y = relative(x);
    const Facing facing = face_triangle(y);
    return facing.inside ? facing.height_squared : find_nearest_border(y, triangle_borders).squared_distance;
}

double squared_distance_edges(const Stencil& x) {
    const Stencil y = relative(x);
    const Facing facing = face_edges(y);
    return facing.inside ? facing.height_squared : find_nearest_border(y, edge_borders).squared_distance;
}

double squared_distance_end(const Stencil& x, int i) {
    const Border& border = edge_borders[static_cast<std::size_t>(i)];
    const Vec3 p = x.col(border.point), start = x.col(border.start), end = x.col(border.end);
    return (p - start - closest_parameter(p, start, end) * (end - start)).squaredNorm();
}

Vec12 squared_distance_gradient(const Separation& separation) {
    Vec12 gradient;
    Eigen::Map<Stencil>(gradient.data()) = 2 * separation.offset * separation.weights.transpose();
    return gradient;
}

Vec3 midpoint(const Separation& separation, const Stencil& x) {
    // The weights are those of the difference: of either sign, and 1 in all on each side.
    return 0.5 * x * separation.weights.cwiseAbs();
}

Separation with_orthonormal_tangents(const Separation& separation) {
    Separation s = separation;
    for (int k = 0; k < s.freedom; ++k) {
        if (k == 1) {
            const double along = s.tangents.col(0).dot(s.tangents.col(1));
            s.tangents.col(1) -= along * s.tangents.col(0);
            s.slides.col(1) -= along * s.slides.col(0);
        }
        const double length = s.tangents.col(k).norm();
        s.tangents.col(k) /= length;
        s.slides.col(k) /= length;
    }
    return s;
}

Mat12 squared_distance_hessian(const Separation& separation) {
    const Separation s = with_orthonormal_tangents(separation);
    Mat12 hessian;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            hessian.block<3, 3>(3 * i, 3 * j) = 2 * s.weights[i] * s.weights[j] * Mat3::Identity();
    for (int k = 0; k < s.freedom; ++k) {
        const Stencil u = s.tangents.col(k) * s.weights.transpose() + s.offset * s.slides.col(k).transpose();
        const Eigen::Map<const Vec12> column(u.data());
        hessian.noalias() -= 2 * column * column.transpose();
    }
    return hessian;
}

} // namespace plisse
