#include <plisse/solve/trust_region_iterate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plisse {

double agreement(double actual, double predicted, double noise) {
    if (std::abs(actual) < noise && std::abs(predicted) < noise)
        return 1;
    return predicted > 0 && std::isfinite(actual) ? actual / predicted : -std::numeric_limits<double>::infinity();
}

namespace {

/// Factor of the radius after a rejection: to where the parabola of f and its slope at x, and of f at the step's end,
/// has its minimum, within bounds.
double shrinking_factor(const TrustRegionConstants& constants, const TrialStep& trial) {
    if (trial.slope >= 0)
        return constants.gamma1;
    const double above_tangent = -trial.actual - trial.slope;
    return std::clamp(-0.5 * trial.slope / above_tangent, constants.least_gamma, constants.gamma1);
}

} // namespace

double next_radius(const TrustRegionConstants& constants, double radius, const TrialStep& trial) {
    if (trial.ratio <= constants.eta1)
        return shrinking_factor(constants, trial) * std::min(radius, trial.norm);
    return trial.ratio > constants.eta2 ? constants.gamma2 * radius : radius;
}

void TrustRegionIterate::start(VecX x0) {
    tilt_.resize(0);
    begin(std::move(x0));
    update_gradient();
}

void TrustRegionIterate::start(VecX x0, const VecX& gradient) {
    start(std::move(x0));
    tilt_ = free_part(gradient) - gradient_;
    gradient_ += tilt_;
}

void TrustRegionIterate::begin(VecX x0) {
    x0_ = x_ = std::move(x0);
    value_ = start_value_ = value_at(x_);
    matrix_is_current_ = near_ = false;
}

double TrustRegionIterate::value_at(const VecX& x) {
    ++evaluations_;
    double value = objective_.value(x);
    if (tilt_.size() > 0)
        value += tilt_.dot(x - x0_);
    return std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
}

double TrustRegionIterate::noise(double value) const {
    return std::max(constants_.noise * std::max(1e-3, std::abs(value)), objective_.round_off());
}

VecX TrustRegionIterate::free_part(const VecX& vertices) const {
    const NewtonSystem& system = objective_.system();
    return system.scatter(system.gather(vertices));
}

void TrustRegionIterate::update_gradient() {
    VecX gradient;
    objective_.gradient(x_, gradient);
    gradient_ = free_part(gradient);
    if (tilt_.size() > 0)
        gradient_ += tilt_;
}

void TrustRegionIterate::update_matrix() {
    NewtonSystem& system = objective_.system();
    const bool is_definite = solver_.wants_definite() && !near_;
    objective_.assemble(x_, system, is_definite);
    ++assemblies_;
    solver_.set_matrix(system);
    if (!solver_.wants_definite())
        return;
    if (!is_definite) {
        if (!definite_)
            definite_ = std::make_unique<NewtonSystem>(system);
        objective_.assemble(x_, *definite_, true);
        ++assemblies_;
    }
    solver_.set_definite(is_definite ? system : *definite_);
}

TrialStep TrustRegionIterate::step(double radius) {
    NewtonSystem& system = objective_.system();
    if (!std::exchange(matrix_is_current_, true))
        update_matrix();
    const QuadraticStep model = solver_.minimize(system.gather(gradient_), radius);
    ++quadratic_solves_;
    quadratic_products_ += model.products;
    TrialStep trial;
    trial.radius = radius;
    trial.norm = model.norm;
    trial.on_boundary = model.on_boundary;
    trial.quadratic_iterations = model.iterations;
    const VecX step = system.scatter(model.s);
    if (!step.allFinite()) {
        trial.ratio = -std::numeric_limits<double>::infinity();
        trial.length = std::numeric_limits<double>::infinity();
        return trial;
    }
    const double alpha = objective_.max_step(x_, step);
    trial.cut = alpha < 1;
    VecX end = x_ + alpha * step;
    const double value = value_at(end);
    trial.length = alpha * step.norm();
    trial.actual = value_ - value;
    trial.predicted = model.decrease(alpha);
    trial.slope = alpha * model.slope;
    trial.ratio = trial.length > 0 ? agreement(trial.actual, trial.predicted, noise(value_)) : 0;
    trial.in_noise = std::abs(trial.actual) < noise(value_) && std::abs(trial.predicted) < noise(value_);
    trial.accepted = trial.ratio > constants_.eta1;
    if (trial.accepted) {
        near_ = !trial.on_boundary && !trial.cut;
        move_to(std::move(end), value);
    }
    return trial;
}

void TrustRegionIterate::move_to(VecX x, double value) {
    x_ = std::move(x);
    value_ = value;
    matrix_is_current_ = false;
    update_gradient();
}

} // namespace plisse
