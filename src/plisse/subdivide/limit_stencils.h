#pragma once

#include <array>
#include <span>

#include <Eigen/Core>

#include <plisse/base/types.h>

namespace plisse {

/// Weights of the control points of a face at points of its limit surface, one row a control point, one column a point;
/// derivatives by the face's own (u, v), which run from corner 0 to corner 1 and to corner 3.
struct FaceStencil {
    Eigen::MatrixXd value, du, dv, duu, duv, dvv;
};

/// Weights of the control points of a boundary edge at points of it; the tangent is the derivative by its parameter,
/// which runs over [0, 1] with the surface on its left.
struct EdgeStencil {
    Eigen::MatrixXd value, tangent;
};

/// Uniform cubic B-spline pieces: weights of four control points in a row at t in [0, 1] between the middle ones.
Eigen::Vector4d bspline(double t);
Eigen::Vector4d bspline_derivative(double t);
Eigen::Vector4d bspline_second_derivative(double t);

/// The stencil of a face whose corners have these valences, for the points of its FaceRing, at points of [0, 1]^2 that
/// are no corner of valence other than 4. Exact: the face is divided until each point lies in an ordinary part of it,
/// which is a bicubic B-spline (as in Stam 1998, by subdivision steps in place of their eigenvectors).
FaceStencil face_stencil(const std::array<int, 4>& valence, std::span<const Vec2> points);

} // namespace plisse
