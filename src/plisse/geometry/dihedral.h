#pragma once

#include <array>

#include <plisse/base/types.h>

namespace plisse {

using Vec12 = Eigen::Matrix<double, 12, 1>;
using Mat12 = Eigen::Matrix<double, 12, 12>;

/// A hinge: the faces (x0, x1, x2) and (x1, x0, x3) on the edge from x0 to x1. Its angle theta turns the normal of the
/// first face into that of the second about the edge: 0 when flat, positive on a ridge seen from the normals' side,
/// +-pi when folded onto itself.
///
/// Symbols: L edge length, e unit edge; per face h height over the edge, N unit normal, a = N x (+-e) the unit vector
/// in the face from the edge to its corner, t the corner's foot on the edge (0 at x0, 1 at x1). Derivatives are our own
/// closed forms (Tamstorf and Grinspun 2013 give another): they hold at every angle, since no trigonometric function of
/// theta is inverted in them. Both faces must have an area for them.
struct Dihedral {
    double angle;
    double length;
    Vec3 edge;
    std::array<Vec3, 2> inward; ///< a
    std::array<Vec3, 2> normal; ///< N
    std::array<double, 2> height;
    std::array<double, 2> foot;
};

/// theta in [-pi, pi], by atan2; NaN where a face has no area.
double dihedral_angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3);

Dihedral dihedral(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3);

/// d theta / d (x0, x1, x2, x3): -N/h at either corner, shared out over the edge by the corner's foot.
Vec12 dihedral_gradient(const Dihedral& hinge);

/// The Hessian of theta as four 2x2 matrices:  d2 theta = sum_k  modes_k curvature_k modes_k^T,
/// with modes_k columns 2k and 2k+1 of `modes`, and  d theta = -sqrt(2) modes.col(0).
///
/// With r = dx2 - (1-t) dx0 - t dx1 the corner's motion relative to its foot, R = r/h (and R' of the other face), and
/// Y = (dx1 - dx0)/L, the second variation of theta is
///   2 R_a R_N + 2 R'_a R'_N + 2 R_e Y_N + 2 R'_e Y_N' + Y_a Y_N + Y_a' Y_N'.
/// Sums and differences of the two faces and the bisector b of the normals (c at right angles) split it into
///   (R_N + R'_N, R_a + R'_a), (R_N - R'_N, R_a - R'_a), (R_e + R'_e, Y_b), (R_e - R'_e, Y_c),
/// each of the first three sums over sqrt(2): an orthonormal basis in (R, R', Y). Positive semi-definite parts of any
/// combination of d2 theta and the square of d theta are therefore those of 2x2 matrices.
struct DihedralModes {
    Eigen::Matrix<double, 12, 8> modes;
    std::array<Mat2, 4> curvature;
};
DihedralModes dihedral_modes(const Dihedral& hinge);

/// d2 theta, 12x12, symmetric.
Mat12 dihedral_hessian(const Dihedral& hinge);

} // namespace plisse
