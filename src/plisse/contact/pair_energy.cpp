#include <plisse/contact/pair_energy.h>

#include <Eigen/Eigenvalues>

#include <plisse/geometry/barrier.h>
#include <plisse/geometry/mollifier.h>

namespace plisse {

namespace {

/// The barrier as a function of D: value and derivatives times the pair's scale.
Barrier scaled_barrier(const PairParameters& p, double squared_distance) {
    const double range = p.activation_squared - p.least_squared;
    const Barrier b = barrier((squared_distance - p.least_squared) / range);
    return {p.scale * b.value, p.scale * b.first / range, p.scale * b.second / (range * range)};
}

/// d2E/dd2 of the distance d, for E a function of D = d^2.
double curvature_in_distance(const Barrier& b, double squared_distance) {
    return std::max(0.0, 4 * b.second * squared_distance + 2 * b.first);
}

/// (w x n)(w x n)^T times a factor.
Mat12 rank_one(double factor, const Vec4& w, const Vec3& n) {
    Vec12 direction;
    Eigen::Map<Stencil>(direction.data()) = n * w.transpose();
    return factor * direction * direction.transpose();
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

/// A bound on the Hessian of the barrier alone, term by term.
Mat12 projected_barrier(const Separation& separation, const Barrier& b) {
    Separation s = with_orthonormal_tangents(separation);
    if (s.freedom == 2)
        make_slides_orthogonal(s);
    const double d = std::sqrt(s.squared_distance), c = -2 * b.first;
    const Vec3 n = s.offset / d;
    Mat12 result = rank_one(curvature_in_distance(b, s.squared_distance), s.weights, n);
    const double w = s.weights.norm();
    for (int k = 0; k < s.freedom; ++k) {
        // In the orthonormal directions v_k x n and w x t_k the term is c [[p^2, p w], [p w, 0]].
        const double v = s.slides.col(k).norm(), p = d * v;
        const double eigenvalue = 0.5 * (p * p + p * std::sqrt(p * p + 4 * w * w));
        const double length_squared = eigenvalue * eigenvalue + p * p * w * w;
        Vec12 direction; // of the eigenvector (eigenvalue, p w)
        Eigen::Map<Stencil>(direction.data()) =
            (eigenvalue / v) * n * s.slides.col(k).transpose() + p * s.tangents.col(k) * s.weights.transpose();
        result.noalias() += (c * eigenvalue / length_squared * direction) * direction.transpose();
    }
    return result;
}

/// Positive part of a translation-invariant 12x12 matrix, found in nine dimensions.
Mat12 translation_free_positive_part(const Mat12& hessian) {
    Eigen::Matrix<double, 12, 9> basis;
    const std::array<Vec4, 3> relative = {Vec4(.5, .5, -.5, -.5), Vec4(.5, -.5, .5, -.5), Vec4(.5, -.5, -.5, .5)};
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 4; ++i)
            basis.block<3, 3>(3 * i, 3 * k) = relative[static_cast<std::size_t>(k)][i] * Mat3::Identity();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> eigen(basis.transpose() * hessian * basis);
    Mat12 result = Mat12::Zero();
    for (int i = 8; i >= 0 && eigen.eigenvalues()[i] > 0; --i) {
        const Vec12 direction = basis * eigen.eigenvectors().col(i);
        result.noalias() += (eigen.eigenvalues()[i] * direction) * direction.transpose();
    }
    return result;
}

/// Of the energy without mollifier.
Mat12 barrier_hessian(const Separation& separation, const Barrier& b) {
    const Vec12 by_distance = squared_distance_gradient(separation);
    return b.second * by_distance * by_distance.transpose() + b.first * squared_distance_hessian(separation);
}

Mat12 mollified_hessian(const EdgeMollifier& mollifier, const Separation& separation, const Barrier& b) {
    const Mat12 mixed = b.first * mollifier.gradient() * squared_distance_gradient(separation).transpose();
    return b.value * mollifier.hessian() + mixed + mixed.transpose() +
           mollifier.value() * barrier_hessian(separation, b);
}

double mollifier_value(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    return parameters.ends != 0 ? EdgeMollifier(separation, x, parameters.ends).value() : 1;
}

} // namespace

double pair_energy(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    return mollifier_value(parameters, separation, x) * scaled_barrier(parameters, separation.squared_distance).value;
}

double pair_normal_force(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const Vec12 gradient = pair_gradient(parameters, separation, x);
    Vec3 on_first = gradient.head<3>();
    if (parameters.ends != 0)
        on_first += gradient.segment<3>(3);
    return -on_first.dot(separation.offset.normalized());
}

Vec12 pair_gradient(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const Barrier b = scaled_barrier(parameters, separation.squared_distance);
    const Vec12 by_distance = b.first * squared_distance_gradient(separation);
    if (parameters.ends == 0)
        return by_distance;
    const EdgeMollifier mollifier(separation, x, parameters.ends);
    return mollifier.value() * by_distance + b.value * mollifier.gradient();
}

Mat12 pair_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const Barrier b = scaled_barrier(parameters, separation.squared_distance);
    if (parameters.ends == 0)
        return barrier_hessian(separation, b);
    return mollified_hessian(EdgeMollifier(separation, x, parameters.ends), separation, b);
}

Mat12 pair_projected_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const Barrier b = scaled_barrier(parameters, separation.squared_distance);
    if (parameters.scale < 0)
        return translation_free_positive_part(barrier_hessian(separation, b));
    if (parameters.ends != 0)
        if (const EdgeMollifier mollifier(separation, x, parameters.ends); !mollifier.is_one())
            return translation_free_positive_part(mollified_hessian(mollifier, separation, b));
    return projected_barrier(separation, b);
}

Mat12 pair_gauss_newton_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const double m = mollifier_value(parameters, separation, x);
    const Barrier b = scaled_barrier(parameters, separation.squared_distance);
    return rank_one(m * curvature_in_distance(b, separation.squared_distance), separation.weights,
                    separation.offset.normalized());
}

} // namespace plisse
