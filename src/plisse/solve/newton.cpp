#include <plisse/solve/newton.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <plisse/solve/script_drive.h>

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

/// One minimisation: the state that its iterations share.
class Newton {
public:
    Newton(Objective& objective, LinearSolver& solver, VecX& x, const NewtonOptions& options, Context& context)
        : objective_(objective), solver_(solver), x_(x), options_(options), context_(context),
          script_(objective.system().prescribed(), objective.script_of()) {}

    NewtonSummary run(const std::function<void(const NewtonIteration&)>& observe) {
        value_ = evaluate(x_);
        for (;;) {
            if (context_.cancelled())
                return ended(NewtonEnd::cancelled, "cancelled");
            const VecX u = script_.step(x_, objective_.targets(), options_.target_tolerance);
            summary_.remaining = script_.remaining();
            const Direction direction = newton_direction(u);
            if (script_.waits() && direction.norm <= options_.tolerance) {
                script_.go_on();
                continue;
            }
            if (finished(direction))
                return summary_;
            raise_penalty(direction);
            const double alpha = line_search(direction);
            count_cuts(direction, alpha);
            if (script_.drives() && (alpha == 0 || cut_steps_ >= options_.most_cut_steps)) {
                block_script();
                continue;
            }
            if (alpha == 0)
                return ended(NewtonEnd::stalled, "no decrease along a step of " + in_words(direction));
            accept(u, alpha);
            if (observe)
                observe({summary_.iterations, value_, direction.norm, alpha, summary_.remaining,
                         std::exchange(limit_is_news_, false) ? limit_ : StepLimit{}});
            if (short_steps_ >= options_.max_short_steps)
                return ended(NewtonEnd::stalled,
                             "steps are cut again and again, the last one of " + in_words(direction));
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
        if (end != NewtonEnd::converged && !limit_.cause.empty())
            summary_.message += fmt::format("; last cut by {}: {}", limit_.cause, limit_.detail);
        return summary_;
    }

    static std::string in_words(const Direction& direction) {
        return fmt::format("{:.3g} m at vertex {}", direction.norm, direction.worst_vertex);
    }

    /// Counts steps that are cut short, and finds out what cuts them.
    void count_cuts(const Direction& direction, double alpha) {
        short_steps_ = alpha < options_.short_step ? short_steps_ + 1 : 0;
        cut_steps_ = alpha < options_.cut_step ? cut_steps_ + 1 : 0;
        if (cut_steps_ == 0)
            return;
        if (cut_steps_ == 1) {
            before_cuts_ = x_;
            value_before_cuts_ = value_;
            penalty_before_cuts_ = script_.penalty();
        }
        if (cut_steps_ == 1 || !script_.drives()) // a script's further ones are taken back
            limit_ = what_cut(direction, alpha);
        limit_is_news_ = limit_is_news_ || cut_steps_ == options_.most_cut_steps;
    }

    StepLimit what_cut(const Direction& direction, double alpha) {
        const double searched = feasible_ > 0 ? alpha / feasible_ : 1;
        if (feasible_ <= searched) {
            const StepLimit limit = objective_.step_limit(x_, direction.d);
            return limit.cause.empty() ? StepLimit{"step filter", fmt::format("{:.3g} of a step is safe", feasible_)}
                                       : limit;
        }
        if (shift_ > 0)
            return {"indefiniteness",
                    fmt::format("the Hessian was shifted by {:.3g}, and the value sinks along {:.3g} of the safe step "
                                "only",
                                shift_, searched)};
        return {"line search", fmt::format("the value sinks along {:.3g} of the safe step only", searched)};
    }

    /// Takes back the steps that were cut, which only squeeze what is in the way, and lets the free unknowns go first.
    void block_script() {
        if (cut_steps_ > 1) {
            x_ = before_cuts_;
            value_ = value_before_cuts_;
            script_.penalty() = penalty_before_cuts_;
        }
        script_.block();
        short_steps_ = cut_steps_ = 0;
        full_step_ = false;
    }

    /// Makes the quadratic model of the merit decrease along the whole step.
    void raise_penalty(const Direction& direction) {
        ScriptPenalty& penalty = script_.penalty();
        if (script_.drives())
            penalty.weight =
                std::max(penalty.weight, 2 * (direction.slope + std::max(direction.curvature, 0.0)) / penalty.share);
    }

    /// Where the last step was taken in full, the last factor is tried first: a step with it that is half of the
    /// last one tells that H has hardly changed (simplified Newton correction, Deuflhard 2004).
    Direction newton_direction(const VecX& u) {
        objective_.gradient(x_, gradient_);
        objective_.system().set_prescribed_step(u);
        if (full_step_ && !script_.drives() && factor_is_current_choice()) {
            const Direction simplified = solve(u, Accuracy::rough);
            if (simplified.norm <= simplified_contraction * summary_.step_norm)
                return chosen(simplified);
        }
        factorize(objective_.system());
        return chosen(solve(u, Accuracy::fine));
    }

    enum class Accuracy { rough, fine };

    Direction solve(const VecX& u, Accuracy accuracy) {
        PhaseScope scope(context_.times, Phase::linear_solve);
        const NewtonSystem& system = objective_.system();
        const VecX rhs = system.gather(-gradient_ - system.coupling());
        const VecX solution = accuracy == Accuracy::fine ? solver_.solve(system, rhs) : solver_.solve_roughly(rhs);
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
        if (full_step_ && !script_.drives() && exact_wait_ == 0) {
            objective_.assemble(x_, system, false);
            PhaseScope scope(context_.times, Phase::linear_solve);
            if (solver_.try_factorize(system)) {
                exact_failures_ = 0;
                shift_ = 0;
                factor_ = Factor::exact;
                return;
            }
            exact_wait_ = std::min(2 << exact_failures_++, most_exact_wait);
        }
        exact_wait_ = std::max(0, exact_wait_ - 1);
        objective_.assemble(x_, system, true);
        PhaseScope scope(context_.times, Phase::linear_solve);
        shift_ = solver_.factorize(system);
        factor_ = Factor::projected;
    }

    /// Converged, at the cap, or lost.
    bool finished(const Direction& direction) {
        if (!std::isfinite(direction.norm)) {
            ended(NewtonEnd::stalled, fmt::format("the step is not finite at vertex {}", direction.worst_vertex));
            return true;
        }
        if (direction.norm <= options_.tolerance && (summary_.remaining == 0 || script_.gave_up())) {
            if (summary_.remaining == 0)
                ended(NewtonEnd::converged, "converged");
            else
                ended(NewtonEnd::blocked, fmt::format("the script is blocked {:.3g} m short", summary_.remaining));
            return true;
        }
        if (summary_.iterations < options_.max_iterations)
            return false;
        ended(NewtonEnd::iteration_cap,
              fmt::format("cut short after {} iterations with a step of {}", summary_.iterations, in_words(direction)));
        return true;
    }

    /// The step length that was accepted, with trial_ and trial_value_ at its end; 0 when none was.
    double line_search(const Direction& direction) {
        PhaseScope scope(context_.times, Phase::line_search);
        ScriptPenalty& penalty = script_.penalty();
        const double merit = value_ + penalty.value();
        const double merit_slope = direction.slope - penalty.value();
        const double noise = objective_.round_off() + 1e-14 * std::max(std::abs(value_), std::abs(merit));
        double alpha = feasible_ = objective_.max_step(x_, direction.d);
        for (int halving = 0; halving <= options_.max_halvings && alpha > 0; ++halving, alpha *= 0.5) {
            trial_ = x_ + alpha * direction.d;
            trial_value_ = evaluate(trial_);
            const double trial_merit = trial_value_ + penalty.value() * (1 - alpha);
            if (trial_merit <= merit + options_.sufficient_decrease * alpha * merit_slope + noise)
                return alpha == 1 && !script_.drives() ? extended(direction) : alpha;
            // Contact that begins on the way is not in the model that set the weight: it is raised to what this takes.
            if (script_.drives() && halving >= most_script_halvings && std::isfinite(trial_value_)) {
                penalty.weight = std::max(penalty.weight, 2 * (trial_value_ - value_) / (penalty.share * alpha));
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
        if (alpha == 1 && script_.drives()) { // land exactly, free of the rounding of x + u
            x_ = (u.array() != 0).select(objective_.targets(), x_);
            value_ = evaluate(x_);
        }
        script_.penalty().share *= 1 - alpha;
        full_step_ = alpha >= 1;
        ++summary_.iterations;
        objective_.on_accepted(x_);
    }

    Objective& objective_;
    LinearSolver& solver_;
    VecX& x_;
    const NewtonOptions& options_;
    Context& context_;
    NewtonSummary summary_;
    ScriptDrive script_;
    VecX gradient_, trial_;
    double value_ = 0, trial_value_ = 0;
    double feasible_ = 1; ///< share of the last direction that its filter lets through
    double shift_ = 0;    ///< of the last factorisation
    int short_steps_ = 0, cut_steps_ = 0;
    StepLimit limit_;            ///< of the last step that was cut
    bool limit_is_news_ = false; ///< whether it has yet to be told
    VecX before_cuts_;
    double value_before_cuts_ = 0;
    ScriptPenalty penalty_before_cuts_;
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

NewtonSummary minimize(Objective& objective, LinearSolver& solver, VecX& x, const NewtonOptions& options,
                       Context& context, const std::function<void(const NewtonIteration&)>& observe) {
    return Newton(objective, solver, x, options, context).run(observe);
}

} // namespace plisse
