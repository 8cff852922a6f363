#include <plisse/energy/shell_point.h>

#include <cmath>

#include <Eigen/Geometry>

#include <plisse/energy/positive_part.h>

namespace plisse {

namespace {

constexpr int column_of[3] = {2, 4, 3}; // of x,11 x,22 x,12 in a jet

} // namespace

ShellPoint::ShellPoint(const SurfaceJet& jet, const Vec3& rest_curvature) : jet_(jet) {
    const Vec3 x1 = jet.col(0), x2 = jet.col(1);
    const Vec3 cross = x1.cross(x2);
    const double squared_area = cross.squaredNorm();
    regular_ = squared_area > 0 && std::isfinite(squared_area);
    if (!regular_)
        return;
    normal_ = cross / std::sqrt(squared_area);
    dual_.col(0) = x2.cross(cross) / squared_area;
    dual_.col(1) = cross.cross(x1) / squared_area;
    for (int ab = 0; ab < 3; ++ab) {
        const auto second = jet.col(column_of[ab]);
        b_[ab] = second.dot(normal_);
        christoffel_.row(ab) = second.transpose() * dual_;
    }
    strain_ = Vec3(x1.squaredNorm() - 1, x2.squaredNorm() - 1, x1.dot(x2)) / 2;
    curvature_ = rest_curvature - b_;
}

ShellPoint::CurvatureRows ShellPoint::curvature_rows() const {
    CurvatureRows rows = CurvatureRows::Zero();
    rows.leftCols<2>() = -christoffel_;
    for (int ab = 0; ab < 3; ++ab)
        rows(ab, column_of[ab]) = 1;
    return rows;
}

SurfaceJet ShellPoint::gradient(const ShellSection::Forces& forces) const {
    const Vec3& N = forces.membrane;
    SurfaceJet gradient = -normal_ * (forces.bending.transpose() * curvature_rows());
    gradient.col(0) += N[0] * jet_.col(0) + N[2] / 2 * jet_.col(1);
    gradient.col(1) += N[1] * jet_.col(1) + N[2] / 2 * jet_.col(0);
    return gradient;
}

ShellPoint::Hessian ShellPoint::hessian(const ShellSection::Tangent& tangent, bool project) const {
    const CurvatureRows rows = curvature_rows();
    // Everything is along the normal but the membrane's rows, which touch x,1 and x,2 only.
    Eigen::Matrix<double, 5, 5> normal_part = rows.transpose() * tangent.bending * rows;
    Eigen::Matrix<double, 3, 6> strain_rows; // dE in the unknowns (x,1)_a and (x,2)_a, column 2a + r
    for (int a = 0; a < 3; ++a) {
        strain_rows.col(2 * a) = Vec3(jet_(a, 0), 0, jet_(a, 1) / 2);
        strain_rows.col(2 * a + 1) = Vec3(0, jet_(a, 1), jet_(a, 0) / 2);
    }
    const Eigen::Matrix<double, 6, 6> membrane_part = strain_rows.transpose() * tangent.membrane * strain_rows;
    // (x,r)_a against the n component of the five: material coupling, and half of d2b's first term.
    Eigen::Matrix<double, 6, 5> coupling_part = -strain_rows.transpose() * tangent.coupling * rows;
    const Vec3& N = tangent.forces.membrane;
    Mat2 tension;
    tension << N[0], N[2] / 2, N[2] / 2, N[1];
    Eigen::Matrix<double, 1, 5> moment = Eigen::Matrix<double, 1, 5>::Zero();
    if (project) {
        tension = positive_part(tension);
    } else {
        moment = tangent.forces.bending.transpose() * rows;
        normal_part.topLeftCorner<2, 2>() += tangent.forces.bending.dot(b_) * dual_.transpose() * dual_;
    }

    Hessian hessian;
    for (int a = 0; a < 3; ++a)
        for (int b = a; b < 3; ++b) {
            Eigen::Matrix<double, 5, 5> block = normal_[a] * normal_[b] * normal_part;
            block.topLeftCorner<2, 2>() += membrane_part.block<2, 2>(2 * a, 2 * b);
            block.topRows<2>() += normal_[b] * coupling_part.middleRows<2>(2 * a);
            block.leftCols<2>() += normal_[a] * coupling_part.middleRows<2>(2 * b).transpose();
            // 2 (n . dx,c)(a^c . v) with v = sum moment_r d(jet column r)
            for (int c = 0; c < 2; ++c) {
                block.row(c) += normal_[a] * dual_(b, c) * moment;
                block.col(c) += normal_[b] * dual_(a, c) * moment.transpose();
            }
            if (a == b)
                block.topLeftCorner<2, 2>() += tension;
            hessian.block<5, 5>(5 * a, 5 * b) = block;
            if (a != b)
                hessian.block<5, 5>(5 * b, 5 * a) = block.transpose();
        }
    return hessian;
}

} // namespace plisse
