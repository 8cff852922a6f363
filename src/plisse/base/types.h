#pragma once

#include <Eigen/Core>

#include <array>

namespace plisse {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Mat32 = Eigen::Matrix<double, 3, 2>;
using VecX = Eigen::VectorXd;

/// Points, one column each. Its storage is x0 y0 z0 x1 y1 z1 ..., so it maps onto a vector of 3n unknowns without a
/// copy.
using Positions = Eigen::Matrix3Xd;
using ConstPositions = Eigen::Ref<const Eigen::Matrix3Xd>;

/// Vertex indices of a triangle (counter-clockwise seen from its front) and of an edge.
using Face = std::array<int, 3>;
using Edge = std::array<int, 2>;

/// The 3n unknowns seen as n points.
inline Eigen::Map<const Positions> as_positions(const VecX& x) {
    return {x.data(), 3, x.size() / 3};
}
inline Eigen::Map<Positions> as_positions(VecX& x) {
    return {x.data(), 3, x.size() / 3};
}

/// n points seen as 3n unknowns.
inline Eigen::Map<const VecX> as_vector(const Positions& x) {
    return {x.data(), x.size()};
}

} // namespace plisse
