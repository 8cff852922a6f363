#include <plisse/solve/conjugate_gradient_step.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Eigenvalues>

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

/// Minimum of g.y + y.Hy/2 over |y| <= radius in the plane.
Vec2 plane_minimum(const Mat2& h, const Vec2& g, double radius) {
    const Eigen::SelfAdjointEigenSolver<Mat2> eigen(h);
    const Vec2 lambda = eigen.eigenvalues(), c = eigen.eigenvectors().transpose() * g;
    const auto step = [&](double shift) { return Vec2(-c.array() / (lambda.array() + shift)); };
    double low = std::max(0.0, -lambda[0]), high = low + c.norm() / radius;
    Vec2 y = lambda[0] > 0 ? step(0) : Vec2::Constant(std::numeric_limits<double>::infinity());
    if (!(y.norm() <= radius)) {
        for (int k = 0; k < 100 && low < high; ++k) {
            const double middle = 0.5 * (low + high);
            (step(middle).norm() > radius ? low : high) = middle;
        }
        y = step(high);
        if (lambda[0] < 0) // the hard case, or near it: out along the softer axis
            y[0] = std::copysign(std::sqrt(std::max(0.0, radius * radius - y[1] * y[1])), c[0] > 0 ? -1.0 : 1.0);
    }
    return eigen.eigenvectors() * y;
}

/// The minimum of the model in the plane of a step and the gradient within the Euclidean radius (Byrd, Schnabel and
/// Shultz 1988).
QuadraticStep plane_step(const NewtonSystem& matrix, const VecX& gradient, const QuadraticStep& step, double radius) {
    Eigen::Matrix<double, Eigen::Dynamic, 2> axes(gradient.size(), 2), products(gradient.size(), 2);
    axes.col(0) = gradient.normalized();
    axes.col(1) = step.s.normalized();
    for (int round = 0; round < 2; ++round) // twice is enough
        axes.col(1) = (axes.col(1) - axes.col(0).dot(axes.col(1)) * axes.col(0)).eval();
    if (axes.col(1).norm() < 1e-8)
        axes.col(1).setZero();
    else
        axes.col(1).normalize();
    for (int k = 0; k < 2; ++k)
        products.col(k) = matrix.multiply(axes.col(k));
    Mat2 h = axes.transpose() * products;
    h(0, 1) = h(1, 0);
    const Vec2 y = plane_minimum(h, axes.transpose() * gradient, radius);
    QuadraticStep best;
    best.s = axes * y;
    best.slope = gradient.dot(best.s);
    best.curvature = y.dot(h * y);
    best.norm = best.s.norm();
    best.on_boundary = best.norm >= radius * (1 - 1e-9);
    best.iterations = step.iterations + 2;
    best.products = step.products + 2;
    return best;
}

} // namespace

ConjugateGradientStep::ConjugateGradientStep(const QuadraticOptions& options,
                                             std::unique_ptr<Preconditioner> preconditioner)
    : options_(options), preconditioner_(std::move(preconditioner)) {}

void ConjugateGradientStep::set_matrix(const NewtonSystem& matrix) {
    matrix_ = &matrix;
    if (preconditioner_ && !options_.project)
        preconditioner_->set_matrix(matrix);
}

QuadraticStep ConjugateGradientStep::minimize(const VecX& gradient, double radius) {
    QuadraticStep step = iterate(gradient, radius, preconditioner_.get());
    // Rounding may spoil the preconditioner of a strongly indefinite H, which then shows no way down.
    if (preconditioner_ && !(step.decrease() > 0) && !gradient.isZero(0)) {
        const double spoilt = step.products;
        step = iterate(gradient, radius, nullptr);
        step.products += spoilt;
        return step;
    }
    if (step.on_boundary && preconditioner_ && options_.norm == RadiusNorm::euclidean)
        return plane_step(*matrix_, gradient, step, radius);
    return step;
}

QuadraticStep ConjugateGradientStep::iterate(const VecX& gradient, double radius,
                                             const Preconditioner* preconditioner) const {
    const auto preconditioned = [&](const VecX& residual) {
        return preconditioner ? preconditioner->apply(residual) : residual;
    };
    const double products_to_precondition = preconditioner ? preconditioner->products() : 0;
    QuadraticStep step;
    step.products = products_to_precondition;
    step.s = VecX::Zero(gradient.size());
    VecX product_of_s = step.s, residual = gradient, z = preconditioned(residual), d = -z;
    double energy = residual.dot(z);
    const double enough = options_.tolerance * options_.tolerance * energy;
    const bool measured = !preconditioner || options_.norm == RadiusNorm::euclidean;
    Lengths lengths;
    lengths.dd = energy;
    while (energy > enough && step.iterations < options_.max_iterations) {
        const VecX product = matrix_->multiply(d);
        ++step.iterations;
        step.products += 1 + products_to_precondition;
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
