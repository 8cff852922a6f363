#include <plisse/contact/pair_energy.h>

#include <Eigen/Eigenvalues>

#include <plisse/contact/barrier.h>
#include <plisse/geometry/mollifier.h>

namespace plisse {

namespace {

/// The barrier as a function of D: value and derivatives times the pair's scale.
Barrier scaled_barrier(const PairParameters& p, double squared_distance) {
    const Barrier b = barrier(squared_distance / p.activation_squared);
    return {p.scale * b.value, p.scale * b.first / p.activation_squared,
            p.scale * b.second / (p.activation_squared * p.activation_squared)};
}

Mollifier mollifier_of(const PairParameters& p, const Stencil& x) {
    return p.mollifier_threshold > 0 ? mollify(cross_squared(x), p.mollifier_threshold) : Mollifier();
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

/// basis * (the positive part of inner) * basis^T.
template <int Size>
Mat12 lifted_positive_part(const Eigen::Matrix<double, 12, Size>& basis,
                           const Eigen::Matrix<double, Size, Size>& inner) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, Size, Size>> eigen(inner);
    Mat12 result = Mat12::Zero();
    for (int i = Size - 1; i >= 0 && eigen.eigenvalues()[i] > 0; --i) {
        const Vec12 direction = basis * eigen.eigenvectors().col(i);
        result.noalias() += (eigen.eigenvalues()[i] * direction) * direction.transpose();
    }
    return result;
}

/// The positive part of b''(D) dD dD^T + b'(D) d2D for `Freedom` slides. With orthonormal tangents t_k, slides v_k, the
/// weights w, the unit offset n and distance d, the matrix is
///   a (w x n)(w x n)^T + c sum_k [d (w x t_k)(v_k x n)^T + transpose + d^2 (v_k x n)(v_k x n)^T],
///   a = 4 b'' d^2 + 2 b', c = -2 b' >= 0,
/// and, for less than two slides, -c (w x m)(w x m)^T in the other directions m across n and the tangents, which
/// project to nothing. With q_i from Gram-Schmidt over w, v_1, v_2 the vectors q_i x n, q_0 x t_k are an orthonormal
/// basis.
template <int Freedom>
Mat12 projected_barrier(const Separation& separation, const Barrier& b) {
    constexpr int size = 1 + 2 * Freedom;
    const Separation s = with_orthonormal_tangents(separation);
    const double d_squared = s.squared_distance, d = std::sqrt(d_squared), c = -2 * b.first;
    const Vec3 n = s.offset / d;

    Eigen::Matrix<double, 4, Freedom + 1> q;
    const double w_length = s.weights.norm();
    q.col(0) = s.weights / w_length;
    Eigen::Matrix<double, size, size> inner = Eigen::Matrix<double, size, size>::Zero();
    inner(0, 0) = (4 * b.second * d_squared + 2 * b.first) * w_length * w_length;
    for (int k = 0; k < Freedom; ++k) {
        Eigen::Matrix<double, Freedom + 1, 1> coefficients = Eigen::Matrix<double, Freedom + 1, 1>::Zero();
        Vec4 rest = s.slides.col(k);
        for (int i = 0; i <= k; ++i) {
            coefficients[i] = q.col(i).dot(rest);
            rest -= coefficients[i] * q.col(i);
        }
        coefficients[k + 1] = rest.norm();
        q.col(k + 1) = rest / coefficients[k + 1];
        inner.template topLeftCorner<Freedom + 1, Freedom + 1>() +=
            c * d_squared * coefficients * coefficients.transpose();
        inner.template block<Freedom + 1, 1>(0, Freedom + 1 + k) = c * d * w_length * coefficients;
        inner.template block<1, Freedom + 1>(Freedom + 1 + k, 0) = c * d * w_length * coefficients.transpose();
    }

    Eigen::Matrix<double, 12, size> basis;
    for (int i = 0; i <= Freedom; ++i)
        Eigen::Map<Stencil>(basis.col(i).data()) = n * q.col(i).transpose();
    for (int k = 0; k < Freedom; ++k)
        Eigen::Map<Stencil>(basis.col(Freedom + 1 + k).data()) = s.tangents.col(k) * q.col(0).transpose();
    return lifted_positive_part<size>(basis, inner);
}

/// Positive part of a translation-invariant 12x12 matrix, found in nine dimensions.
Mat12 translation_free_positive_part(const Mat12& hessian) {
    Eigen::Matrix<double, 12, 9> basis;
    const std::array<Vec4, 3> relative = {Vec4(.5, .5, -.5, -.5), Vec4(.5, -.5, .5, -.5), Vec4(.5, -.5, -.5, .5)};
    for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 4; ++i)
            basis.block<3, 3>(3 * i, 3 * k) = relative[static_cast<std::size_t>(k)][i] * Mat3::Identity();
    return lifted_positive_part<9>(basis, basis.transpose() * hessian * basis);
}

Mat12 mollified_hessian(const Mollifier& m, const Barrier& b, const Separation& separation, const Stencil& x) {
    const Vec12 by_cross = cross_squared_gradient(x), by_distance = squared_distance_gradient(separation);
    const Mat12 mixed = by_cross * by_distance.transpose();
    return b.value * (m.second * by_cross * by_cross.transpose() + m.first * cross_squared_hessian(x)) +
           m.first * b.first * (mixed + mixed.transpose()) +
           m.value *
               (b.second * by_distance * by_distance.transpose() + b.first * squared_distance_hessian(separation));
}

} // namespace

double pair_energy(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    return mollifier_of(parameters, x).value * scaled_barrier(parameters, separation.squared_distance).value;
}

Vec12 pair_gradient(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const Barrier b = scaled_barrier(parameters, separation.squared_distance);
    const Mollifier m = mollifier_of(parameters, x);
    Vec12 gradient = m.value * b.first * squared_distance_gradient(separation);
    if (m.first != 0)
        gradient += m.first * b.value * cross_squared_gradient(x);
    return gradient;
}

Mat12 pair_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    return mollified_hessian(mollifier_of(parameters, x), scaled_barrier(parameters, separation.squared_distance),
                             separation, x);
}

Mat12 pair_projected_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const Barrier b = scaled_barrier(parameters, separation.squared_distance);
    const Mollifier m = mollifier_of(parameters, x);
    if (m.value < 1)
        return translation_free_positive_part(mollified_hessian(m, b, separation, x));
    if (separation.freedom == 2)
        return projected_barrier<2>(separation, b);
    if (separation.freedom == 1)
        return projected_barrier<1>(separation, b);
    return projected_barrier<0>(separation, b);
}

Mat12 pair_gauss_newton_hessian(const PairParameters& parameters, const Separation& separation, const Stencil& x) {
    const double m = mollifier_of(parameters, x).value;
    const Barrier b = scaled_barrier(parameters, separation.squared_distance);
    return rank_one(m * curvature_in_distance(b, separation.squared_distance), separation.weights,
                    separation.offset.normalized());
}

} // namespace plisse
