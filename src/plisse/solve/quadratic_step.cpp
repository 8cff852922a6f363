#include <plisse/solve/quadratic_step.h>

#include <algorithm>
#include <cmath>

#include <plisse/solve/conjugate_gradient_step.h>
#include <plisse/solve/factored_step.h>

namespace plisse {

namespace {

std::unique_ptr<Preconditioner> make_preconditioner(const QuadraticOptions& options,
                                                    std::span<const ScalarTransfer* const> prolongations) {
    switch (options.preconditioning) {
    case Preconditioning::block_jacobi:
        return std::make_unique<BlockJacobi>();
    case Preconditioning::block_gauss_seidel:
        return std::make_unique<BlockGaussSeidel>();
    case Preconditioning::multigrid:
        return std::make_unique<Multigrid>(prolongations, options.multigrid);
    case Preconditioning::none:
        break;
    }
    return nullptr;
}

} // namespace

std::unique_ptr<QuadraticSolver> make_quadratic_solver(const QuadraticOptions& options,
                                                       std::span<const ScalarTransfer* const> prolongations) {
    switch (options.method) {
    case QuadraticMethod::dogleg:
        return std::make_unique<DoglegStep>();
    case QuadraticMethod::exact:
        return std::make_unique<ExactStep>();
    case QuadraticMethod::conjugate_gradients:
        break;
    }
    return std::make_unique<ConjugateGradientStep>(options, make_preconditioner(options, prolongations));
}

BoundarySteps steps_to_boundary(double ss, double sd, double dd, double radius) {
    const double gap = std::max(0.0, (radius - std::sqrt(ss)) * (radius + std::sqrt(ss)));
    const double root = std::sqrt(sd * sd + dd * gap);
    // The larger root by magnitude first: the other from their product, without cancellation.
    const double far = sd > 0 ? -(sd + root) / dd : (root - sd) / dd;
    const double near = far != 0 ? -gap / (dd * far) : 0;
    return {std::min(far, near), std::max(far, near)};
}

QuadraticStep cauchy_step(const NewtonSystem& matrix, const VecX& gradient, double radius) {
    const double length = gradient.norm();
    if (length == 0)
        return {VecX::Zero(gradient.size()), 0, 0, 0, false, 0, 0};
    const VecX d = -gradient / length;
    const double curvature = d.dot(matrix.multiply(d));
    const bool inside = curvature > 0 && length / curvature < radius;
    const double tau = inside ? length / curvature : radius;
    return {tau * d, -tau * length, tau * tau * curvature, tau, !inside, 1, 1};
}

} // namespace plisse
