#include <plisse/solve/conjugate_gradient_step.h>

#include <cmath>
#include <utility>

namespace plisse {

namespace {

/// s.s, s.d and d.d in the norm of the radius. In that of the preconditioner they follow from what conjugate gradients
/// compute anyway, without M.
struct Lengths {
    double ss = 0, sd = 0, dd = 0;

    void measure(const VecX& s, const VecX& d) {
        ss = s.squaredNorm();
        sd = s.dot(d);
        dd = d.squaredNorm();
    }
    void move(double alpha) {
        ss += alpha * (2 * sd + alpha * dd);
        sd += alpha * dd;
    }
    void turn(double beta, double energy) {
        sd *= beta;
        dd = energy + beta * beta * dd;
    }
};

} // namespace

ConjugateGradientStep::ConjugateGradientStep(const QuadraticOptions& options,
                                             std::unique_ptr<Preconditioner> preconditioner)
    : options_(options), preconditioner_(std::move(preconditioner)) {}

void ConjugateGradientStep::set_matrix(const NewtonSystem& matrix) {
    matrix_ = &matrix;
    if (preconditioner_)
        preconditioner_->set_matrix(matrix);
}

QuadraticStep ConjugateGradientStep::minimize(const VecX& gradient, double radius) {
    QuadraticStep step = iterate(gradient, radius);
    if (step.on_boundary && preconditioner_ && options_.norm == RadiusNorm::euclidean) {
        QuadraticStep cauchy = cauchy_step(*matrix_, gradient, radius);
        cauchy.iterations += step.iterations;
        if (!(step.decrease() >= cauchy.decrease()))
            return cauchy;
    }
    return step;
}

QuadraticStep ConjugateGradientStep::iterate(const VecX& gradient, double radius) const {
    QuadraticStep step;
    step.s = VecX::Zero(gradient.size());
    VecX product_of_s = step.s, residual = gradient, z = preconditioned(residual), d = -z;
    double energy = residual.dot(z);
    const double enough = options_.tolerance * options_.tolerance * energy;
    const bool measured = !preconditioner_ || options_.norm == RadiusNorm::euclidean;
    Lengths lengths;
    lengths.dd = energy;
    while (energy > enough && step.iterations < options_.max_iterations) {
        const VecX product = matrix_->multiply(d);
        ++step.iterations;
        if (measured)
            lengths.measure(step.s, d);
        const double curvature = d.dot(product);
        const double to_boundary = steps_to_boundary(lengths.ss, lengths.sd, lengths.dd, radius).upper;
        const double length = energy / curvature;
        step.on_boundary = !(curvature > 0 && length < to_boundary);
        const double alpha = step.on_boundary ? to_boundary : length;
        step.s += alpha * d;
        product_of_s += alpha * product;
        lengths.move(alpha);
        if (step.on_boundary)
            break;
        residual += alpha * product;
        z = preconditioned(residual);
        const double before = std::exchange(energy, residual.dot(z));
        const double beta = energy / before;
        d = beta * d - z;
        lengths.turn(beta, energy);
    }
    step.slope = gradient.dot(step.s);
    step.curvature = step.s.dot(product_of_s);
    step.norm = measured ? step.s.norm() : std::sqrt(lengths.ss);
    return step;
}

} // namespace plisse
