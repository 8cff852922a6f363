#include <plisse/solve/newton.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace plisse {

namespace {

/// A search direction with what the line search needs to know of it.
struct Direction {
    VecX d;
    double slope = 0;     ///< gradient . d
    double curvature = 0; ///< d . H d
    double norm = 0;
    int worst_vertex = -1;
};

VecX step_to_targets(const Objective& objective, const NewtonSystem& system, const VecX& x, double tolerance) {
    VecX u = VecX::Zero(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i)
        if (system.prescribed()[static_cast<std::size_t>(i)])
            u[i] = objective.targets()[i] - x[i];
    if (u.lpNorm<Eigen::Infinity>() <= tolerance)
        u.setZero();
    return u;
}

/// Factorises, shifting the diagonal where round-off has made H indefinite.
void factorize_shifted(SparseCholesky& cholesky, const NewtonSystem& system) {
    double largest = 0;
    for (double value : system.values())
        largest = std::max(largest, std::abs(value));
    double shift = 0;
    while (!cholesky.factorize(system, shift))
        shift = std::max(1e-12 * largest, 10 * shift);
}

Direction newton_direction(Objective& objective, SparseCholesky& cholesky, const VecX& x, const VecX& gradient,
                           const VecX& u, Context& context) {
    NewtonSystem& system = objective.system();
    system.set_prescribed_step(u);
    objective.assemble(x, system);
    PhaseScope scope(context.times, Phase::linear_solve);
    factorize_shifted(cholesky, system);
    const VecX rhs = system.gather(-gradient - system.coupling());
    const VecX solution = cholesky.solve(rhs);
    Direction direction;
    const VecX free_step = system.scatter(solution);
    direction.d = free_step + u;
    direction.slope = gradient.dot(direction.d);
    // d.Hd = f.Hf + 2 f.Hu + u.Hu, and H f = rhs on the free rows.
    direction.curvature =
        rhs.dot(solution) + 2 * free_step.dot(system.coupling()) + u.dot(system.coupling());
    direction.norm = largest_nodal_norm(direction.d, &direction.worst_vertex);
    return direction;
}

/// The exact penalty of prescribed unknowns on their way: weight * share, where share is 1 at the start of the solve and
/// shrinks by (1 - alpha) with each step.
struct Penalty {
    double share = 0;
    double weight = 0;

    double value() const { return weight * share; }
    /// Makes the quadratic model of the merit decrease along the whole step.
    void raise_for(const Direction& direction) {
        if (share <= 0)
            return;
        const double needed = direction.slope + std::max(direction.curvature, 0.0);
        weight = std::max(weight, 2 * needed / share);
    }
};

} // namespace

double largest_nodal_norm(const VecX& vector, int* where) {
    const auto points = as_positions(vector);
    double largest = 0;
    if (where)
        *where = -1;
    for (int i = 0; i < points.cols(); ++i) {
        const double norm = points.col(i).norm();
        if (norm > largest || std::isnan(norm)) {
            largest = norm;
            if (where)
                *where = i;
        }
    }
    return largest;
}

NewtonSummary minimize(Objective& objective, SparseCholesky& cholesky, VecX& x, const NewtonOptions& options,
                       Context& context, const std::function<void(const NewtonIteration&)>& observe) {
    NewtonSummary summary;
    VecX gradient(x.size());
    double value = objective.value(x);
    ++summary.evaluations;
    Penalty penalty;
    penalty.share = 1;
    int short_steps = 0;
    for (;;) {
        if (context.cancelled()) {
            summary.end = NewtonEnd::cancelled;
            summary.message = "cancelled";
            return summary;
        }
        const VecX u = step_to_targets(objective, objective.system(), x, options.target_tolerance);
        summary.remaining = largest_nodal_norm(u);
        if (summary.remaining == 0)
            penalty.share = 0;
        objective.gradient(x, gradient);
        const Direction direction = newton_direction(objective, cholesky, x, gradient, u, context);
        summary.step_norm = direction.norm;
        summary.worst_vertex = direction.worst_vertex;
        if (!std::isfinite(direction.norm)) {
            summary.end = NewtonEnd::stalled;
            summary.message = fmt::format("the Newton direction is not finite at vertex {}", direction.worst_vertex);
            return summary;
        }
        if (summary.remaining == 0 && direction.norm <= options.tolerance) {
            summary.end = NewtonEnd::converged;
            summary.message = "converged";
            return summary;
        }
        if (summary.iterations >= options.max_iterations) {
            summary.end = NewtonEnd::iteration_cap;
            summary.message =
                fmt::format("cut short after {} iterations with a step of {:.3g} m at vertex {}", summary.iterations,
                            direction.norm, direction.worst_vertex);
            return summary;
        }
        penalty.raise_for(direction);

        double alpha = objective.max_step(x, direction.d);
        const double merit = value + penalty.value();
        const double merit_slope = direction.slope - penalty.value();
        const double noise = 1e-14 * std::max({std::abs(value), std::abs(merit), 1e-300});
        VecX trial;
        double trial_value = std::numeric_limits<double>::infinity();
        bool accepted = false;
        {
            PhaseScope scope(context.times, Phase::line_search);
            for (int halving = 0; halving <= options.max_halvings && alpha > 0; ++halving, alpha *= 0.5) {
                trial = x + alpha * direction.d;
                trial_value = objective.value(trial);
                ++summary.evaluations;
                const double trial_merit = trial_value + penalty.value() * (1 - alpha);
                if (trial_merit <= merit + options.sufficient_decrease * alpha * merit_slope + noise) {
                    accepted = true;
                    break;
                }
            }
        }
        short_steps = alpha < options.short_step ? short_steps + 1 : 0;
        if (!accepted || short_steps >= options.max_short_steps) {
            summary.end = NewtonEnd::stalled;
            summary.message = fmt::format("stalled: {} with a step of {:.3g} m at vertex {}",
                                          accepted ? "steps are cut again and again" : "no decrease along the direction",
                                          direction.norm, direction.worst_vertex);
            return summary;
        }
        x = trial;
        if (alpha == 1) // land exactly, free of the rounding of x + u
            for (Eigen::Index i = 0; i < x.size(); ++i)
                if (u[i] != 0)
                    x[i] = objective.targets()[i];
        value = alpha == 1 && summary.remaining > 0 ? objective.value(x) : trial_value;
        penalty.share *= 1 - alpha;
        ++summary.iterations;
        objective.on_accepted(x);
        if (observe)
            observe({summary.iterations, value, direction.norm, alpha, summary.remaining});
    }
}

} // namespace plisse
