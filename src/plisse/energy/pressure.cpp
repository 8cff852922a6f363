#include <plisse/energy/pressure.h>

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <plisse/base/parallel.h>
#include <plisse/energy/neo_hookean.h>

namespace plisse {

namespace {

Mat3 cross_matrix(const Vec3& a) {
    Mat3 matrix;
    matrix << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
    return matrix;
}

Vec3 twice_area_normal(const Face& face, const Positions& x) {
    const Vec3 x0 = x.col(face[0]);
    return (x.col(face[1]) - x0).cross(x.col(face[2]) - x0);
}

Vec3 centre_of(const Positions& x, std::span<const Face> faces) {
    Vec3 sum = Vec3::Zero();
    for (const Face& face : faces)
        for (int v : face)
            sum += x.col(v);
    return faces.empty() ? sum : Vec3(sum / (3.0 * static_cast<double>(faces.size())));
}

/// Corners relative to the face's centre, one column each.
Mat3 centred_corners(const Face& face, const Positions& x) {
    Mat3 corners;
    corners << x.col(face[0]), x.col(face[1]), x.col(face[2]);
    const Vec3 centre = corners.rowwise().mean();
    return corners.colwise() - centre;
}

/// Symmetric part of d(n/6 at each corner)/dx, n twice the area vector: block (k, k+1) is -[y_(k+2)]x/4.
Mat9 force_derivative(const Mat3& corners) {
    Mat9 derivative = Mat9::Zero();
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const Mat3 block = cross_matrix(corners.col((k + 2) % 3)) / 4;
        derivative.block<3, 3>(3 * k, 3 * next) = -block;
        derivative.block<3, 3>(3 * next, 3 * k) = block;
    }
    return derivative;
}

/// Positive part of scale * force_derivative. The matrix couples motions along the normal N with motions in the plane
/// only: it is C N^T + N C^T, with eigenvalues +-sigma, sigma the singular values of C (9x3).
Mat9 positive_force_derivative(const Mat3& corners, const Vec3& normal, double scale) {
    Eigen::Matrix<double, 9, 3> lift = Eigen::Matrix<double, 9, 3>::Zero();
    Eigen::Matrix<double, 9, 3> coupling = Eigen::Matrix<double, 9, 3>::Zero();
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        const Vec3 turned = (scale / 4) * corners.col((k + 2) % 3).cross(normal);
        lift.block<3, 1>(3 * k, k) = normal;
        coupling.block<3, 1>(3 * k, next) = -turned;
        coupling.block<3, 1>(3 * next, k) = turned;
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> squared(coupling.transpose() * coupling);
    Mat9 result = Mat9::Zero();
    for (int i = 0; i < 3; ++i) {
        const double sigma = std::sqrt(std::max(squared.eigenvalues()[i], 0.0));
        if (sigma <= std::numeric_limits<double>::min())
            continue;
        const Vec3 direction = squared.eigenvectors().col(i);
        const Eigen::Matrix<double, 9, 1> mode = coupling * (direction / sigma) + lift * direction;
        result += (sigma / 2) * mode * mode.transpose();
    }
    return result;
}

} // namespace

PressureEnergy::PressureEnergy(const Positions& rest, std::vector<Face> faces, double pressure)
    : faces_(std::move(faces)), pressure_(pressure), reference_(centre_of(rest, faces_)) {
    if (volume(rest) < 0)
        orientation_ = -1;
}

double PressureEnergy::signed_volume(int face, const Positions& x) const {
    const Face& v = faces_[static_cast<std::size_t>(face)];
    return orientation_ / 6 * (x.col(v[0]) - reference_).dot(twice_area_normal(v, x));
}

double PressureEnergy::volume(const Positions& x) const {
    return parallel_sum(element_count(), [&](int face) { return signed_volume(face, x); });
}

double PressureEnergy::value(int face, const Positions& x) const {
    return -pressure_ * signed_volume(face, x);
}

void PressureEnergy::gradient(int face, const Positions& x, double* gradient) const {
    const Vec3 normal = twice_area_normal(faces_[static_cast<std::size_t>(face)], x);
    Eigen::Map<Mat3>(gradient).colwise() = (-pressure_ * orientation_ / 6) * normal;
}

void PressureEnergy::hessian(int face, const Positions& x, bool project, double* hessian) const {
    const Face& v = faces_[static_cast<std::size_t>(face)];
    const Mat3 corners = centred_corners(v, x);
    const double scale = -pressure_ * orientation_;
    if (project)
        Eigen::Map<Mat9>{hessian} = positive_force_derivative(corners, twice_area_normal(v, x).normalized(), scale);
    else
        Eigen::Map<Mat9>{hessian} = scale * force_derivative(corners);
}

Positions pressure_forces(const Positions& x, std::span<const Face> faces, double pressure) {
    Positions forces = Positions::Zero(3, x.cols());
    for (const Face& face : faces) {
        const Vec3 share = (pressure / 6) * twice_area_normal(face, x);
        for (int v : face)
            forces.col(v) += share;
    }
    return forces;
}

} // namespace plisse
