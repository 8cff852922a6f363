#pragma once

#include <plisse/energy/positive_part.h>
#include <plisse/geometry/dihedral.h>

/// What energies of the angles between faces share.
namespace plisse {

inline Dihedral dihedral_at(const std::array<int, 4>& v, const Positions& x) {
    return dihedral(x.col(v[0]), x.col(v[1]), x.col(v[2]), x.col(v[3]));
}

inline double dihedral_angle_at(const std::array<int, 4>& v, const Positions& x) {
    return dihedral_angle(x.col(v[0]), x.col(v[1]), x.col(v[2]), x.col(v[3]));
}

/// Positive part of stiffness * d theta d theta^T + moment * d2 theta, which for moment = k (theta - rest) is the
/// Hessian of k/2 (theta - rest)^2. None of the 2x2 matrices has two positive eigenvalues, so each is one rank-one
/// term.
inline Mat12 projected_hessian(const Dihedral& hinge, double stiffness, double moment) {
    DihedralModes factors = dihedral_modes(hinge);
    for (Mat2& matrix : factors.curvature)
        matrix *= moment;
    factors.curvature[0](0, 0) += 2 * stiffness; // d theta = -sqrt(2) modes.col(0)
    Eigen::Matrix<double, 12, 4> roots;
    for (int k = 0; k < 4; ++k)
        roots.col(k).noalias() =
            factors.modes.middleCols<2>(2 * k) * positive_root(factors.curvature[static_cast<std::size_t>(k)]);
    return roots.lazyProduct(roots.transpose());
}

} // namespace plisse
