#include <plisse/solve/newton.h>

#include <algorithm>
#include <cmath>

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

/// The exact penalty of prescribed unknowns on their way: weight * share, where share is 1 at the start of the solve
/// and shrinks by (1 - alpha) with each step.
struct Penalty {
    double share = 1;
    double weight = 0;

    double value() const { return weight * share; }
    /// Makes the quadratic model of the merit decrease along the whole step.
    void raise_for(const Direction& direction) {
        if (share > 0)
            weight = std::max(weight, 2 * (direction.slope + std::max(direction.curvature, 0.0)) / share);
    }
};

/// Factorises, shifting the diagonal where round-off has made H indefinite.
void factorize_shifted(SparseCholesky& cholesky, const NewtonSystem& system) {
    double shift = 0;
    while (!cholesky.factorize(system, shift)) {
        double largest = 0;
        for (const Mat3& block : system.blocks())
            largest = std::max(largest, block.cwiseAbs().maxCoeff());
        shift = std::max(1e-12 * largest, 10 * shift);
    }
}

/// One minimisation: the state that its iterations share.
class Newton {
public:
    Newton(Objective& objective, SparseCholesky& cholesky, VecX& x, const NewtonOptions& options, Context& context)
        : objective_(objective), cholesky_(cholesky), x_(x), options_(options), context_(context) {}

    NewtonSummary run(const std::function<void(const NewtonIteration&)>& observe) {
        value_ = evaluate(x_);
        for (;;) {
            if (context_.cancelled())
                return ended(NewtonEnd::cancelled, "cancelled");
            const VecX u = step_to_targets();
            const Direction direction = newton_direction(u);
            if (finished(direction))
                return summary_;
            penalty_.raise_for(direction);
            const double alpha = line_search(direction);
            short_steps_ = alpha < options_.short_step ? short_steps_ + 1 : 0;
            if (alpha == 0)
                return ended(NewtonEnd::stalled, fmt::format("no decrease along a step of {:.3g} m at vertex {}",
                                                             direction.norm, direction.worst_vertex));
            accept(u, alpha);
            if (observe)
                observe({summary_.iterations, value_, direction.norm, alpha, summary_.remaining});
            if (short_steps_ >= options_.max_short_steps)
                return ended(NewtonEnd::stalled, fmt::format("steps of {:.3g} m at vertex {} are cut again and again",
                                                             direction.norm, direction.worst_vertex));
        }
    }

private:
    double evaluate(const VecX& x) {
        ++summary_.evaluations;
        return objective_.value(x);
    }

    NewtonSummary ended(NewtonEnd end, const std::string& message) {
        summary_.end = end;
        summary_.message = message;
        return summary_;
    }

    VecX step_to_targets() {
        const auto& prescribed = objective_.system().prescribed();
        VecX u = VecX::Zero(x_.size());
        for (Eigen::Index i = 0; i < x_.size(); ++i)
            if (prescribed[static_cast<std::size_t>(i)])
                u[i] = objective_.targets()[i] - x_[i];
        if (u.lpNorm<Eigen::Infinity>() <= options_.target_tolerance)
            u.setZero();
        summary_.remaining = largest_nodal_norm(u);
        if (summary_.remaining == 0)
            penalty_.share = 0;
        return u;
    }

    /// Where the last step was taken in full, the last factor is tried first: a step with it that is half of the
    /// last one tells that H has hardly changed (simplified Newton correction, Deuflhard 2004).
    Direction newton_direction(const VecX& u) {
        objective_.gradient(x_, gradient_);
        objective_.system().set_prescribed_step(u);
        if (full_step_ && penalty_.share == 0 && factor_is_current_choice()) {
            const Direction simplified = solve(u);
            if (simplified.norm <= simplified_contraction * summary_.step_norm)
                return chosen(simplified);
        }
        factorize(objective_.system());
        return chosen(solve(u));
    }

    Direction solve(const VecX& u) {
        PhaseScope scope(context_.times, Phase::linear_solve);
        const NewtonSystem& system = objective_.system();
        const VecX rhs = system.gather(-gradient_ - system.coupling());
        const VecX solution = cholesky_.solve(rhs);
        Direction direction;
        const VecX free_step = system.scatter(solution);
        direction.d = free_step + u;
        direction.slope = gradient_.dot(direction.d);
        // d.Hd = f.Hf + 2 f.Hu + u.Hu, and H f = rhs on the free rows.
        direction.curvature = rhs.dot(solution) + 2 * free_step.dot(system.coupling()) + u.dot(system.coupling());
        direction.norm = largest_nodal_norm(direction.d, &direction.worst_vertex);
        return direction;
    }

    Direction chosen(Direction direction) {
        summary_.step_norm = direction.norm;
        summary_.worst_vertex = direction.worst_vertex;
        return direction;
    }

    /// Whether the factor at hand is of the Hessian that would be tried now, the exact or the projected one: the former
    /// knows soft directions that the latter does not.
    bool factor_is_current_choice() const {
        return factor_ == Factor::exact || (factor_ == Factor::projected && exact_wait_ > 0);
    }

    /// Projection keeps H definite but too stiff wherever compression softens the shell, and steps then shrink by a
    /// constant factor only. So where the last step was taken in full the exact Hessian is tried, and the projected one
    /// serves when that is indefinite; after a failure it is left alone for a while.
    void factorize(NewtonSystem& system) {
        if (full_step_ && penalty_.share == 0 && exact_wait_ == 0) {
            objective_.assemble(x_, system, false);
            PhaseScope scope(context_.times, Phase::linear_solve);
            if (cholesky_.factorize(system)) {
                exact_failures_ = 0;
                factor_ = Factor::exact;
                return;
            }
            exact_wait_ = std::min(2 << exact_failures_++, most_exact_wait);
        }
        exact_wait_ = std::max(0, exact_wait_ - 1);
        objective_.assemble(x_, system, true);
        PhaseScope scope(context_.times, Phase::linear_solve);
        factorize_shifted(cholesky_, system);
        factor_ = Factor::projected;
    }

    /// Converged, at the cap, or lost.
    bool finished(const Direction& direction) {
        if (!std::isfinite(direction.norm)) {
            ended(NewtonEnd::stalled, fmt::format("the step is not finite at vertex {}", direction.worst_vertex));
            return true;
        }
        if (summary_.remaining == 0 && direction.norm <= options_.tolerance) {
            ended(NewtonEnd::converged, "converged");
            return true;
        }
        if (summary_.iterations < options_.max_iterations)
            return false;
        ended(NewtonEnd::iteration_cap,
              fmt::format("cut short after {} iterations with a step of {:.3g} m at vertex {}", summary_.iterations,
                          direction.norm, direction.worst_vertex));
        return true;
    }

    /// The step length that was accepted, with trial_ and trial_value_ at its end; 0 when none was.
    double line_search(const Direction& direction) {
        PhaseScope scope(context_.times, Phase::line_search);
        const double merit = value_ + penalty_.value();
        const double merit_slope = direction.slope - penalty_.value();
        const double noise = objective_.round_off() + 1e-14 * std::max(std::abs(value_), std::abs(merit));
        double alpha = objective_.max_step(x_, direction.d);
        for (int halving = 0; halving <= options_.max_halvings && alpha > 0; ++halving, alpha *= 0.5) {
            trial_ = x_ + alpha * direction.d;
            trial_value_ = evaluate(trial_);
            const double trial_merit = trial_value_ + penalty_.value() * (1 - alpha);
            if (trial_merit <= merit + options_.sufficient_decrease * alpha * merit_slope + noise)
                return alpha == 1 && penalty_.share == 0 ? extended(direction) : alpha;
            // Contact that begins on the way is not in the model that set the weight: it is raised to what this takes.
            if (penalty_.share > 0 && halving >= most_script_halvings && std::isfinite(trial_value_)) {
                penalty_.weight = std::max(penalty_.weight, 2 * (trial_value_ - value_) / (penalty_.share * alpha));
                return alpha;
            }
        }
        return 0;
    }

    /// Where a full step has lowered the value by clearly more than the model said, H is too stiff along it: projection
    /// makes it so where the shell is about to buckle. The step is then doubled for as long as that pays.
    double extended(const Direction& direction) {
        double alpha = 1;
        if (value_ - trial_value_ < stiff_ratio * 0.5 * std::abs(direction.slope) + 1e3 * objective_.round_off())
            return alpha;
        while (alpha < longest_step) {
            const double feasible = objective_.max_step(x_, 2 * alpha * direction.d);
            const double next = 2 * alpha * feasible;
            if (next <= alpha)
                break;
            const VecX further = x_ + next * direction.d;
            const double further_value = evaluate(further);
            if (!(further_value < trial_value_))
                break;
            alpha = next;
            trial_ = further;
            trial_value_ = further_value;
            if (feasible < 1)
                break;
        }
        return alpha;
    }

    void accept(const VecX& u, double alpha) {
        std::swap(x_, trial_);
        value_ = trial_value_;
        if (alpha == 1 && summary_.remaining > 0) { // land exactly, free of the rounding of x + u
            x_ = (u.array() != 0).select(objective_.targets(), x_);
            value_ = evaluate(x_);
        }
        penalty_.share *= 1 - alpha;
        full_step_ = alpha >= 1;
        ++summary_.iterations;
        objective_.on_accepted(x_);
    }

    Objective& objective_;
    SparseCholesky& cholesky_;
    VecX& x_;
    const NewtonOptions& options_;
    Context& context_;
    NewtonSummary summary_;
    Penalty penalty_;
    VecX gradient_, trial_;
    double value_ = 0, trial_value_ = 0;
    int short_steps_ = 0;
    enum class Factor { none, exact, projected } factor_ = Factor::none;
    static constexpr double simplified_contraction = 0.5;
    static constexpr int most_exact_wait = 8;
    static constexpr int most_script_halvings = 2;
    static constexpr double stiff_ratio = 1.5;
    static constexpr double longest_step = 64;
    bool full_step_ = false;
    int exact_wait_ = 0, exact_failures_ = 0;
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
    return Newton(objective, cholesky, x, options, context).run(observe);
}

} // namespace plisse
