#include <plisse/solve/factored_step.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <plisse/base/random.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

double largest_row_sum(const NewtonSystem& matrix) {
    VecX sums = VecX::Zero(3 * matrix.row_count());
    for (int c = 0; c < matrix.row_count(); ++c)
        for (int k = matrix.column_starts()[at(c)]; k < matrix.column_starts()[at(c) + 1]; ++k) {
            const Mat3 block = matrix.blocks()[at(matrix.block_numbers()[at(k)])].cwiseAbs();
            const int row = matrix.block_rows()[at(k)];
            sums.segment<3>(3 * row) += block.rowwise().sum();
            if (row != c)
                sums.segment<3>(3 * c) += block.colwise().sum().transpose();
        }
    return sums.size() > 0 ? sums.maxCoeff() : 0;
}

/// Inverse iteration: a unit vector near the eigenvector of the lowest eigenvalue, for a factor of H + shift I with a
/// shift that is close.
VecX softest_direction(ShiftedCholesky& factor, Eigen::Index size) {
    constexpr int iterations = 4;
    Random random(1);
    VecX u(size);
    for (double& entry : u)
        entry = random.uniform(-1, 1);
    for (int k = 0; k < iterations; ++k)
        u = factor.solve(u.normalized());
    return u.normalized();
}

QuadraticStep described(const NewtonSystem& matrix, const VecX& gradient, VecX s, double radius) {
    QuadraticStep step;
    step.slope = gradient.dot(s);
    step.curvature = s.dot(matrix.multiply(s));
    step.norm = s.norm();
    step.on_boundary = step.norm >= radius * (1 - 1e-9);
    step.s = std::move(s);
    return step;
}

/// From s inside the radius along u to the radius, the way on which the model is lower.
QuadraticStep carried_to_boundary(const NewtonSystem& matrix, const VecX& gradient, const VecX& s, const VecX& u,
                                  double radius) {
    const BoundarySteps tau = steps_to_boundary(s.squaredNorm(), s.dot(u), u.squaredNorm(), radius);
    const QuadraticStep one = described(matrix, gradient, s + tau.lower * u, radius);
    const QuadraticStep other = described(matrix, gradient, s + tau.upper * u, radius);
    return one.decrease() > other.decrease() ? one : other;
}

} // namespace

void DoglegStep::set_matrix(const NewtonSystem& matrix) {
    matrix_ = &matrix;
    factorized_ = false;
}

QuadraticStep DoglegStep::minimize(const VecX& gradient, double radius) {
    if (!factorized_)
        shift_ = factor_.factorize(*matrix_);
    factorized_ = true;
    const VecX newton = -factor_.solve(gradient);
    QuadraticStep step, cauchy = cauchy_step(*matrix_, gradient, radius);
    if (newton.norm() <= radius) {
        step = described(*matrix_, gradient, newton, radius);
        if (shift_ > 0) {
            const VecX u = softest_direction(factor_, gradient.size());
            const QuadraticStep carried = carried_to_boundary(*matrix_, gradient, newton, u, radius);
            step = carried.decrease() > step.decrease() ? carried : step;
        }
    } else {
        const double squared = gradient.squaredNorm();
        const double shifted = gradient.dot(matrix_->multiply(gradient)) + shift_ * squared;
        const VecX knee = -(squared / shifted) * gradient;
        if (knee.norm() < radius) {
            const VecX leg = newton - knee;
            const double tau = steps_to_boundary(knee.squaredNorm(), knee.dot(leg), leg.squaredNorm(), radius).upper;
            step = described(*matrix_, gradient, knee + tau * leg, radius);
        } else {
            step = cauchy;
        }
    }
    if (!(step.decrease() >= cauchy.decrease()))
        step = cauchy;
    step.iterations = 1;
    step.products = products_of_direct_solve;
    return step;
}

void ExactStep::set_matrix(const NewtonSystem& matrix) {
    matrix_ = &matrix;
    largest_row_ = largest_row_sum(matrix);
    least_shift_ = -1;
}

QuadraticStep ExactStep::minimize(const VecX& gradient, double radius) {
    QuadraticStep step = search(gradient, radius);
    const QuadraticStep cauchy = cauchy_step(*matrix_, gradient, radius);
    const int iterations = step.iterations;
    if (!(step.decrease() >= cauchy.decrease()))
        step = cauchy;
    step.iterations = iterations;
    step.products = iterations * products_of_direct_solve;
    return step;
}

QuadraticStep ExactStep::search(const VecX& gradient, double radius) {
    constexpr int most_factorizations = 60;
    constexpr double near_boundary = 0.01, near_optimum = 0.02;
    const double tiny = 1e-12 * largest_row_;
    const double length = gradient.norm();
    double lower = std::max(0.0, least_shift_), upper = length / radius + largest_row_;
    double shift = lower > 0 ? std::min(std::sqrt(lower * upper), 2 * lower) : 0;
    QuadraticStep best = cauchy_step(*matrix_, gradient, radius);
    const auto bisect = [&] { return std::sqrt(std::max(lower, tiny) * upper); };
    const auto finished = [&](QuadraticStep step, int count) {
        step.iterations = count;
        return step;
    };
    for (int count = 1; count <= most_factorizations; ++count) {
        if (!factor_.try_factorize(*matrix_, shift)) {
            lower = least_shift_ = std::max({lower, shift, tiny});
            shift = bisect();
            continue;
        }
        VecX s = -factor_.solve(gradient);
        const double norm = s.norm();
        if (norm <= radius && shift == 0)
            return finished(described(*matrix_, gradient, s, radius), count);
        if (std::abs(norm - radius) <= near_boundary * radius)
            return finished(described(*matrix_, gradient, s * std::min(1.0, radius / norm), radius), count);
        if (norm < radius) {
            upper = shift;
            const VecX u = softest_direction(factor_, gradient.size());
            const double softness = u.dot(matrix_->multiply(u)) + shift; // H + shift I along u
            least_shift_ = std::max(least_shift_, shift - softness);
            lower = std::max(lower, shift - softness);
            const QuadraticStep carried = carried_to_boundary(*matrix_, gradient, s, u, radius);
            if (carried.decrease() > best.decrease())
                best = carried;
            const double tau = (carried.s - s).norm();
            const double shifted = -gradient.dot(s); // s'(H + shift I)s
            if (tau * tau * softness <= near_optimum * (shifted + shift * radius * radius))
                return finished(carried, count);
        } else {
            lower = std::max(lower, shift);
        }
        if (upper - lower <= 1e-14 * upper)
            break;
        const double rate = s.dot(factor_.solve(s));
        shift += norm * norm / rate * (norm - radius) / radius;
        if (!(shift > lower && shift < upper))
            shift = bisect();
    }
    best.iterations = most_factorizations;
    return best;
}

} // namespace plisse
