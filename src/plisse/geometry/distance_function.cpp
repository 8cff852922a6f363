#include <plisse/geometry/distance_function.h>

#include <cassert>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace plisse {

namespace {

using SmallMatrix = decltype(DistanceFunction::second);
using Gradients = Eigen::Matrix<double, 12, Eigen::Dynamic, 0, 12, DistanceFunction::most>;

Gradients gradients_of(std::span<const Separation> separations) {
    Gradients gradients(12, static_cast<int>(separations.size()));
    for (int a = 0; a < gradients.cols(); ++a)
        gradients.col(a) = squared_distance_gradient(separations[static_cast<std::size_t>(a)]);
    return gradients;
}

/// Makes the columns orthonormal, or zero, and returns R with (columns before) = (columns after) R.
SmallMatrix make_orthonormal(Gradients& columns) {
    const auto count = columns.cols();
    SmallMatrix r = SmallMatrix::Zero(count, count);
    for (int a = 0; a < count; ++a) {
        for (int b = 0; b < a; ++b) {
            r(b, a) = columns.col(b).dot(columns.col(a));
            columns.col(a) -= r(b, a) * columns.col(b);
        }
        r(a, a) = columns.col(a).norm();
        if (r(a, a) > 0)
            columns.col(a) /= r(a, a);
    }
    return r;
}

/// Adds the positive part of G f G^T.
void add_positive_part(const SmallMatrix& f, Gradients gradients, Mat12& sum) {
    const SmallMatrix r = make_orthonormal(gradients);
    const Eigen::SelfAdjointEigenSolver<SmallMatrix> eigen(r * f * r.transpose());
    for (int a = 0; a < f.cols(); ++a)
        if (const double eigenvalue = eigen.eigenvalues()[a]; eigenvalue > 0) {
            const Vec12 direction = gradients * eigen.eigenvectors().col(a);
            sum.noalias() += (eigenvalue * direction) * direction.transpose();
        }
}

/// Turns the two orthonormal tangents in their plane until the slides are at right angles to each other too. Terms that
/// are projected one by one then depend on the points only, not on the order they come in.
void make_slides_orthogonal(Separation& s) {
    const double difference = s.slides.col(0).squaredNorm() - s.slides.col(1).squaredNorm();
    const double twice_product = 2 * s.slides.col(0).dot(s.slides.col(1));
    const double length = std::hypot(difference, twice_product);
    if (length == 0)
        return;
    const double cosine = std::sqrt(0.5 * (1 + difference / length));
    const double sine = std::copysign(std::sqrt(0.5 * std::max(0.0, 1 - difference / length)), twice_product);
    Mat2 turn;
    turn << cosine, -sine, sine, cosine;
    s.slides *= turn;
    s.tangents *= turn;
}

/// Adds first * d2D/dX2 projected term by term, without the term along dD/dX.
void add_projected_terms(double first, const Separation& separation, Mat12& sum) {
    Separation s = with_orthonormal_tangents(separation);
    if (s.freedom == 2)
        make_slides_orthogonal(s);
    const double d = std::sqrt(s.squared_distance), w = s.weights.norm(), c = -2 * first;
    const Vec3 n = s.offset / d;
    for (int k = 0; k < s.freedom; ++k) {
        // In the orthonormal directions v_k x n and w x t_k the term is c [[p^2, p w], [p w, 0]].
        const double v = s.slides.col(k).norm(), p = d * v;
        const double eigenvalue = 0.5 * p * (p + std::copysign(std::sqrt(p * p + 4 * w * w), c));
        const double length_squared = eigenvalue * eigenvalue + p * p * w * w;
        Vec12 direction; // of the eigenvector (eigenvalue, p w)
        Eigen::Map<Stencil>(direction.data()) =
            (eigenvalue / v) * n * s.slides.col(k).transpose() + p * s.tangents.col(k) * s.weights.transpose();
        sum.noalias() += (c * eigenvalue / length_squared * direction) * direction.transpose();
    }
    if (first <= 0)
        return;
    const Eigen::Matrix<double, 3, 2> t = s.tangents;
    const Mat3 across = Mat3::Identity() - n * n.transpose() - t * t.transpose();
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            sum.block<3, 3>(3 * i, 3 * j) += 2 * first * s.weights[i] * s.weights[j] * across;
}

} // namespace

Vec12 gradient(const DistanceFunction& f, std::span<const Separation> separations) {
    assert(f.first.size() == static_cast<int>(separations.size()));
    Vec12 sum = Vec12::Zero();
    for (std::size_t a = 0; a < separations.size(); ++a)
        sum += f.first[static_cast<int>(a)] * squared_distance_gradient(separations[a]);
    return sum;
}

Mat12 hessian(const DistanceFunction& f, std::span<const Separation> separations) {
    const Gradients gradients = gradients_of(separations);
    Mat12 sum = gradients * f.second * gradients.transpose();
    for (std::size_t a = 0; a < separations.size(); ++a)
        sum += f.first[static_cast<int>(a)] * squared_distance_hessian(separations[a]);
    return sum;
}

Mat12 projected_hessian(const DistanceFunction& f, std::span<const Separation> separations) {
    Mat12 sum = Mat12::Zero();
    SmallMatrix second = f.second;
    for (int a = 0; a < f.first.size(); ++a) {
        const Separation& separation = separations[static_cast<std::size_t>(a)];
        second(a, a) += f.first[a] / (2 * separation.squared_distance); // 2 d (w x n) is the gradient
        add_projected_terms(f.first[a], separation, sum);
    }
    add_positive_part(second, gradients_of(separations), sum);
    return sum;
}

} // namespace plisse
