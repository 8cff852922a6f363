#include <plisse/geometry/dihedral.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace plisse {

namespace {

/// The row vectors (rho_0, rho_1) with which edge vertices enter a corner's relative motion, times a direction.
Vec12 relative_motion(const Dihedral& hinge, int face, const Vec3& direction) {
    const auto f = static_cast<std::size_t>(face);
    const Vec3 scaled = direction / hinge.height[f];
    Vec12 row = Vec12::Zero();
    row.segment<3>(0) = (hinge.foot[f] - 1) * scaled;
    row.segment<3>(3) = -hinge.foot[f] * scaled;
    row.segment<3>(6 + 3 * face) = scaled;
    return row;
}

Vec12 edge_motion(const Dihedral& hinge, const Vec3& direction) {
    Vec12 row = Vec12::Zero();
    row.segment<3>(3) = direction / hinge.length;
    row.segment<3>(0) = -row.segment<3>(3);
    return row;
}

} // namespace

double dihedral_angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
    const Vec3 edge = x1 - x0;
    const Vec3 to_x3 = x3 - x0;
    const Vec3 n0 = edge.cross(x2 - x0);
    const Vec3 n1 = to_x3.cross(edge);
    // (n0 x n1) . e = -|edge| n0 . to_x3: exact where the normals are nearly parallel, with one rounding less.
    const double sine = -edge.norm() * n0.dot(to_x3);
    const double cosine = n0.dot(n1);
    // Both vanish only together with a face.
    return sine == 0 && cosine == 0 ? std::numeric_limits<double>::quiet_NaN() : std::atan2(sine, cosine);
}

Dihedral dihedral(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
    Dihedral hinge;
    hinge.angle = dihedral_angle(x0, x1, x2, x3);
    hinge.length = (x1 - x0).norm();
    hinge.edge = (x1 - x0) / hinge.length;
    const std::array<Vec3, 2> arms{x2 - x0, x3 - x0};
    for (std::size_t f = 0; f < 2; ++f) {
        const Vec3 rotated = f == 0 ? Vec3(hinge.edge.cross(arms[f])) : Vec3(arms[f].cross(hinge.edge));
        hinge.height[f] = rotated.norm();
        hinge.normal[f] = rotated / hinge.height[f];
        hinge.inward[f] = f == 0 ? hinge.normal[f].cross(hinge.edge) : hinge.edge.cross(hinge.normal[f]);
        hinge.foot[f] = arms[f].dot(hinge.edge) / hinge.length;
    }
    return hinge;
}

Vec12 dihedral_gradient(const Dihedral& hinge) {
    return -relative_motion(hinge, 0, hinge.normal[0]) - relative_motion(hinge, 1, hinge.normal[1]);
}

DihedralModes dihedral_modes(const Dihedral& hinge) {
    constexpr double root_half = std::numbers::sqrt2 / 2;
    const double cosine = std::cos(hinge.angle / 2);
    const double sine = std::sin(hinge.angle / 2);
    DihedralModes result;
    auto& modes = result.modes;
    const auto set_sum_and_difference = [&](int sum, int difference, const Vec3& first, const Vec3& second) {
        const Vec12 u = root_half * relative_motion(hinge, 0, first);
        const Vec12 v = root_half * relative_motion(hinge, 1, second);
        modes.col(sum) = u + v;
        modes.col(difference) = u - v;
    };
    set_sum_and_difference(0, 2, hinge.normal[0], hinge.normal[1]);
    set_sum_and_difference(1, 3, hinge.inward[0], hinge.inward[1]);
    set_sum_and_difference(4, 6, hinge.edge, hinge.edge);
    modes.col(5) = edge_motion(hinge, cosine * hinge.normal[0] - sine * hinge.inward[0]);
    modes.col(7) = edge_motion(hinge, cosine * hinge.inward[0] + sine * hinge.normal[0]);

    const double turn = std::sin(hinge.angle);
    result.curvature[0] << 0, 1, 1, 0;
    result.curvature[1] = result.curvature[0];
    result.curvature[2] << 0, std::numbers::sqrt2 * cosine, std::numbers::sqrt2 * cosine, -turn;
    result.curvature[3] << 0, std::numbers::sqrt2 * sine, std::numbers::sqrt2 * sine, turn;
    return result;
}

Mat12 dihedral_hessian(const Dihedral& hinge) {
    const DihedralModes factors = dihedral_modes(hinge);
    Eigen::Matrix<double, 12, 8> curved;
    for (int k = 0; k < 4; ++k)
        curved.middleCols<2>(2 * k) =
            factors.modes.middleCols<2>(2 * k) * factors.curvature[static_cast<std::size_t>(k)];
    return curved.lazyProduct(factors.modes.transpose());
}

} // namespace plisse
