#include <plisse/linalg/linear_solver.h>

#include <utility>

namespace plisse {

bool LinearSolver::try_factorize(const NewtonSystem& system) {
    plan_.adapt_to(system);
    return precision_ == Precision::single ? single_.factorize(plan_, system) : full_.factorize(plan_, system);
}

double LinearSolver::factorize(const NewtonSystem& system) {
    if (try_factorize(system))
        return 0;
    precision_ = Precision::full;
    double shift = 0;
    while (!full_.factorize(plan_, system, shift))
        shift = larger_shift(system, shift, 1e-12, 10);
    return shift;
}

void LinearSolver::reset() {
    plan_.reset();
    precision_ = Precision::single;
}

VecX LinearSolver::solve(const NewtonSystem& system, const VecX& right_hand_side) {
    constexpr double tolerance = 1e-3; // of the last correction, which is itself right to about as much
    constexpr int most_iterations = 12;
    if (precision_ == Precision::full)
        return full_.solve(plan_, right_hand_side);
    VecX x = VecX::Zero(right_hand_side.size());
    VecX residual = right_hand_side, correction = solve_roughly(residual), direction = correction;
    double energy = residual.dot(correction);
    const double enough = tolerance * tolerance * energy;
    for (int k = 0; energy > enough && k < most_iterations; ++k) {
        const VecX product = system.multiply(direction);
        const double curvature = direction.dot(product);
        if (!(curvature > 0))
            break;
        const double length = energy / curvature;
        x += length * direction;
        residual -= length * product;
        correction = solve_roughly(residual);
        const double before = std::exchange(energy, residual.dot(correction));
        direction = correction + energy / before * direction;
    }
    if (energy > enough && full_.factorize(plan_, system)) {
        precision_ = Precision::full;
        return full_.solve(plan_, right_hand_side);
    }
    return x + correction;
}

VecX LinearSolver::solve_roughly(const VecX& right_hand_side) {
    if (precision_ == Precision::full)
        return full_.solve(plan_, right_hand_side);
    const double scale = right_hand_side.lpNorm<Eigen::Infinity>(); // single precision has a narrow range
    return scale > 0 ? VecX(scale * single_.solve(plan_, right_hand_side / scale)) : right_hand_side;
}

} // namespace plisse
