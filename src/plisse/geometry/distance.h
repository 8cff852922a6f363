#pragma once

#include <cstdint>
#include <optional>

#include <plisse/base/types.h>

namespace plisse {

/// Two primitives of four points together, one column each: a point and a triangle (p, t0, t1, t2) or two edges
/// (a0, a1, b0, b1).
using Stencil = Eigen::Matrix<double, 3, 4>;
using Vec4 = Eigen::Vector4d;
using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// How two primitives lie at their closest points. The offset r from the second closest point to the first is a
/// weighted sum of the points, r = X w, and the squared distance D = r.r. Each of the closest points may slide within
/// the feature it lies in (a face's or an edge's inside; a corner leaves it no freedom): w changes along the columns of
/// `slides`, and r along those of `tangents` = X slides. At the closest points r is at right angles to the tangents.
/// Primitives of fewer than four points leave the last weights zero.
struct Separation {
    Vec4 weights = Vec4::Zero();
    Eigen::Matrix<double, 4, 2> slides = Eigen::Matrix<double, 4, 2>::Zero();
    Eigen::Matrix<double, 3, 2> tangents = Eigen::Matrix<double, 3, 2>::Zero();
    Vec3 offset = Vec3::Zero();  ///< r, m
    double squared_distance = 0; ///< D, m^2
    int freedom = 0;             ///< slides in use: 0 point-point, 1 point-edge, 2 point-triangle or edge-edge
    std::uint8_t corners = 0;    ///< bit i: point i is a corner of the features that the closest points lie in
};

/// A vector square to u and v, as long as u x v. Its second factor is made square to the first: otherwise the product
/// of nearly parallel vectors leans towards them by a rounding over their sine, and heights along it are as wrong. NaN
/// for u = 0.
Vec3 cross_square(const Vec3& u, const Vec3& v);

Separation separate_points(const Vec3& p, const Vec3& q);
/// Any edge, of no length too.
Separation separate_point_edge(const Vec3& p, const Vec3& e0, const Vec3& e1);
/// Any triangle, degenerate ones too.
Separation separate_point_triangle(const Stencil& x);
/// Any edges: parallel, collinear and of no length too.
Separation separate_edges(const Stencil& x);
/// The same where the closest points lie inside both edges, else nothing, in half the time.
std::optional<Separation> separate_facing_edges(const Stencil& x);

/// Of a point-triangle stencil, the point and the triangle's border from corner k to the next alone; k in {0, 1, 2}.
Separation separate_from_border(const Stencil& x, int k);
/// Of a point-triangle stencil, the point and the triangle's corner k alone.
Separation separate_from_corner(const Stencil& x, int k);
/// Of an edge-edge stencil, point i alone and the whole of the edge that it is not on.
Separation separate_end(const Stencil& x, int i);

/// D alone, for less than half the time.
double squared_distance_point_triangle(const Stencil& x);
double squared_distance_edges(const Stencil& x);
double squared_distance_end(const Stencil& x, int i); ///< of separate_end

/// dD/dX in the order of the stencil, m. D is the least of |X w|^2 over the slides, so its gradient is that at fixed w.
Vec12 squared_distance_gradient(const Separation& separation);
/// d2D/dX2 while the closest features stay the same: 2 (w w^T x I - sum_k u_k u_k^T), u_k = w x t_k + v_k x r with
/// tangents t_k made orthonormal and slides v_k to match (the Schur complement of the least-squares problem in the
/// slides; x is Kronecker's product).
Mat12 squared_distance_hessian(const Separation& separation);

/// The place halfway between the two closest points of a stencil.
Vec3 midpoint(const Separation& separation, const Stencil& x);

/// The same separation with orthonormal tangents.
Separation with_orthonormal_tangents(const Separation& separation);

} // namespace plisse
