#pragma once

#include <plisse/energy/shell_section.h>

namespace plisse {

/// A surface's derivatives at a point, in coordinates along the rest surface's warp and weft that are orthonormal at
/// rest: columns x,1  x,2  x,11  x,12  x,22 (RMTR's comma derivatives).
using SurfaceJet = Eigen::Matrix<double, 3, 5>;

/// First and second derivatives of a Kirchhoff-Love shell's energy in a jet, all closed form. Notation: a^c are the
/// contravariant vectors of x,1 and x,2, n the unit normal, b_ab = x,ab . n, G^c_ab = x,ab . a^c. Strain and change of
/// curvature are E_ab = (x,a . x,b - delta_ab)/2 and kappa = b_rest - b. With dn = -(n . dx,c) a^c:
///   db_ab  = n . (dx,ab - G^c_ab dx,c)
///   d2b_ab = -2 (n . dx,c) a^c . (dx,ab - G^d_ab dx,d) - b_ab (a^c . a^d) (n . dx,c)(n . dx,d)
class ShellPoint {
public:
    /// rest_curvature: b at rest as (11, 22, 12).
    ShellPoint(const SurfaceJet& jet, const Vec3& rest_curvature);

    /// False where x,1 and x,2 are not two directions of finite length; nothing else may be asked then.
    bool regular() const { return regular_; }
    const Vec3& strain() const { return strain_; }
    const Vec3& curvature() const { return curvature_; } ///< kappa

    /// Derivative of the energy in the jet, from its derivatives in strain and curvature.
    SurfaceJet gradient(const ShellSection::Forces& forces) const;
    /// 15 x 15, unknown r of coordinate a at row 5a + r.
    using Hessian = Eigen::Matrix<double, 15, 15>;
    /// project: the second derivative of curvature is left out, and of membrane forces the tension is kept.
    Hessian hessian(const ShellSection::Tangent& tangent, bool project) const;

private:
    using CurvatureRows = Eigen::Matrix<double, 3, 5>;
    /// Row ab holds k with -dkappa_ab = n . sum_r k_r d(jet column r).
    CurvatureRows curvature_rows() const;

    SurfaceJet jet_;
    bool regular_;
    Vec3 strain_, curvature_, normal_;
    Vec3 b_;
    Mat32 dual_;        ///< columns a^1, a^2
    Mat32 christoffel_; ///< row ab, column c: G^c_ab, rows 11, 22, 12
};

} // namespace plisse
