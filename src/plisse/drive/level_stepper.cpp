#include <plisse/drive/level_stepper.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <plisse/drive/friction_updates.h>
#include <plisse/drive/run_fraction.h>

namespace plisse {

namespace {

constexpr double largest_residual = 1e-3; // of the largest nodal force of any one term (CONTRACT.md)
constexpr int preview_iteration_cap = 20;
constexpr int final_iteration_cap = 1000;
// Gaps of the tightest pair of a converged step, over that at which it begins to repel (docs/decisions/0017).
constexpr double least_gap_share = 1e-3;      // below, the barrier is stiffened
constexpr double wanted_gap_share = 3e-2;     // after that
constexpr double helpful_growth = 2;          // else it is not forces that press surfaces together
constexpr double tolerance_share = 0.1;       // of a gap, that counts as converged while it is too small
constexpr double most_stiffness_factor = 1e4; // in a run
constexpr int most_stiffenings = 3;           // in a step

LevelStepper::Outcome outcome_of(const NewtonSummary& summary) {
    switch (summary.end) {
    case NewtonEnd::converged:
        return LevelStepper::Outcome::done;
    case NewtonEnd::iteration_cap:
        return LevelStepper::Outcome::cut_short;
    case NewtonEnd::stalled:
    case NewtonEnd::blocked:
        return LevelStepper::Outcome::stalled;
    case NewtonEnd::cancelled:
        break;
    }
    return LevelStepper::Outcome::cancelled;
}

int timeline_steps(double duration, double h) {
    return static_cast<int>(std::ceil(duration / h - 1e-9));
}

} // namespace

LevelStepper::LevelStepper(const Discretization& discretization, int level, EnergiesOf energies_of, bool is_last,
                           RunLog& log)
    : discretization_(discretization), settings_(discretization.model().solve), level_(level), is_last_(is_last),
      log_(log), problem_(discretization, level, energies_of, log.context()), times_at_start_(log.context().times) {}

void LevelStepper::start_from(const Checkpoint& progress) {
    progress_ = progress;
    x_ = as_vector(progress.positions);
    problem_.enforce_thickness(1, progress_.stiffness_factor);
    problem_.begin_settling_step(progress.positions, progress.t, settings_.time_step, progress.friction);
}

int LevelStepper::iteration_cap() const {
    return settings_.max_iterations_per_step.value_or(is_last_ ? final_iteration_cap : preview_iteration_cap);
}

double LevelStepper::fraction(std::string_view phase) const {
    const RunFraction run(discretization_.model(), discretization_.finest() + 1);
    if (phase != "preview")
        return run.in_settling(level_, progress_.settle_step);
    return run.in_timeline(progress_.step /
                           std::max(1.0, double(timeline_steps(settings_.duration, settings_.time_step))));
}

// Forgetting the ordering here and below makes a resumed run take the same steps, to the bit, as an uninterrupted one.
void LevelStepper::begin_step(double t, double h, const VecX& anchor) {
    solver_.reset();
    problem_.begin_step(as_positions(x_), as_positions(anchor), t, h, progress_.friction.reference.cols() == 0);
}

void LevelStepper::begin_settling_step(double t, double h) {
    solver_.reset();
    problem_.begin_settling_step(as_positions(x_), t, h, progress_.friction);
}

bool LevelStepper::scripts_have_arrived() {
    const auto& prescribed = problem_.system().prescribed();
    for (Eigen::Index i = 0; i < x_.size(); ++i)
        if (prescribed[static_cast<std::size_t>(i)] &&
            std::abs(x_[i] - problem_.targets()[i]) > NewtonOptions{}.target_tolerance)
            return false;
    return true;
}

void LevelStepper::extrapolate(const VecX& motion) {
    const auto& prescribed = problem_.system().prescribed();
    VecX by_script = x_;
    VecX start = x_ + motion;
    for (Eigen::Index i = 0; i < x_.size(); ++i)
        if (prescribed[static_cast<std::size_t>(i)])
            by_script[i] = start[i] = problem_.targets()[i];
    if (problem_.max_step(x_, start - x_) == 1 && problem_.value(start) < problem_.value(by_script))
        x_ = start;
}

NewtonSummary LevelStepper::solve_step(double t, double tolerance, const char* phase, int most_iterations) {
    NewtonOptions options;
    options.tolerance = tolerance * settings_.time_step;
    options.max_iterations = most_iterations;
    LevelReport& report = log_.level_report(level_);
    Progress shown;
    shown.level = level_;
    shown.level_count = discretization_.finest() + 1;
    shown.phase = phase;
    shown.time = t;
    shown.duration = settings_.duration;
    shown.step = report.steps + 1;
    shown.fraction = fraction(phase);
    const NewtonSummary summary =
        minimize(problem_, solver_, x_, options, log_.context(), [&](const NewtonIteration& iteration) {
            shown.iteration = iteration.iteration;
            shown.step_norm = iteration.step_norm / settings_.time_step;
            shown.gap = problem_.min_gap(x_);
            log_.context().on_progress(shown);
            log_.iteration({level_, shown.step, iteration.iteration, t, iteration.value, shown.step_norm, shown.gap,
                            log_.seconds(), iteration.step_length, iteration.limit});
        });
    report.newton_iterations += summary.iterations;
    if (summary.end != NewtonEnd::converged)
        trouble_ = fmt::format("level {}, t = {:.4g} s: {}", level_, t, summary.message);
    if (summary.end == NewtonEnd::stalled || summary.end == NewtonEnd::blocked)
        log_.context().on_message(trouble_);
    return summary;
}

NewtonSummary LevelStepper::solve_rubbing_step(double t, double tolerance, const char* phase, int most_iterations) {
    bool gripped = problem_.friction_grips();
    NewtonSummary whole = solve_step(t, tolerance, phase, most_iterations);
    NewtonSummary part = whole;
    for (int update = 0; whole.end == NewtonEnd::converged && problem_.update_friction(x_, friction_share(update));
         ++update) {
        if (part.iterations == 0 && !gripped)
            break;
        gripped = false;
        if (update == most_friction_updates || whole.iterations == most_iterations) {
            whole.end = NewtonEnd::iteration_cap;
            trouble_ = fmt::format("level {}, t = {:.4g} s: the forces of friction have not come to rest in {} updates",
                                   level_, t, update);
            break;
        }
        part = solve_step(t, tolerance, phase, most_iterations - whole.iterations);
        whole.end = part.end;
        whole.iterations += part.iterations;
    }
    return whole;
}

void LevelStepper::set_stiffness_factor(double factor) {
    progress_.stiffness_factor = factor;
    problem_.enforce_thickness(1, factor);
}

void LevelStepper::stiffen_barrier(double t, const TightestPair& tightest) {
    const double before = progress_.stiffness_factor;
    // At equilibrium, gaps this small grow in proportion.
    set_stiffness_factor(std::min(before * wanted_gap_share / tightest.share, most_stiffness_factor));
    tell_stiffness(t, tightest, fmt::format("becomes {:.3g} times as stiff", progress_.stiffness_factor / before));
}

void LevelStepper::tell_stiffness(double t, const TightestPair& tightest, std::string_view change) {
    const int step = log_.level_report(level_).steps + 1;
    log_.stiffening({level_, step, t, tightest.share, progress_.stiffness_factor, log_.seconds(), tightest.words});
    log_.context().on_message(fmt::format("level {}, t = {:.4g} s: the barrier {} ({:.3g} times as at first): {}, "
                                          "{:.3g} of where they begin to repel",
                                          level_, t, change, progress_.stiffness_factor, tightest.words,
                                          tightest.share));
}

NewtonSummary LevelStepper::solve_pressed_step(double t, double tolerance, const char* phase, int most_iterations) {
    NewtonSummary whole = solve_rubbing_step(t, tolerance, phase, most_iterations);
    TightestPair tightest = problem_.tightest_pair(x_);
    const auto solve_on = [&] {
        const double finer = std::min(tolerance, tolerance_share * tightest.gap / settings_.time_step);
        const NewtonSummary part = solve_rubbing_step(t, finer, phase, std::max(1, most_iterations - whole.iterations));
        whole.end = part.end;
        whole.iterations += part.iterations;
        tightest = problem_.tightest_pair(x_);
    };
    const auto is_too_tight = [&] {
        return whole.end == NewtonEnd::converged && whole.iterations < most_iterations &&
               tightest.share < least_gap_share;
    };
    if (is_too_tight()) // perhaps only within a tolerance that is coarser than the gap
        solve_on();
    for (int times = 0; times < most_stiffenings && progress_.stiffening_helps && is_too_tight(); ++times) {
        const double factor_before = progress_.stiffness_factor, share_before = tightest.share;
        if (factor_before == most_stiffness_factor)
            break;
        stiffen_barrier(t, tightest);
        solve_on();
        if (whole.end == NewtonEnd::converged && tightest.share < helpful_growth * share_before) {
            progress_.stiffening_helps = false;
            set_stiffness_factor(factor_before);
            tell_stiffness(t, tightest, "is as stiff as before again, which it need not be to keep them apart");
            solve_on();
        }
    }
    ++log_.level_report(level_).steps;
    return whole;
}

LevelStepper::Outcome LevelStepper::bring_to_thickness(double t) {
    constexpr int most_rounds = 100;
    constexpr double margin = 1e-3;  // of the contact distance, where the barrier is not yet as steep as a wall
    constexpr double pressed = 0.02; // share of the way out on which surfaces start each round within the barrier
    const ContactSettings& contact = discretization_.model().contact;
    if (contact.thickness == 0)
        return Outcome::done;
    const double outside = 1 + margin * contact.distance / contact.thickness;
    const double tolerance = std::min(settings_.tolerance, 0.1 * contact.distance / settings_.time_step);
    double share = problem_.least_thickness_share(x_);
    if (share < outside)
        log_.context().on_message(fmt::format("level {}: surfaces lie within their contact thickness, the nearest at "
                                              "{:.3g} of it; moving them apart",
                                              level_, share));
    double stiffness_factor = progress_.stiffness_factor;
    Outcome outcome = Outcome::done;
    for (int round = 0; share < outside; ++round) {
        if (round == most_rounds) {
            outcome = Outcome::cut_short;
            break;
        }
        const VecX before = x_;
        begin_step(t, settings_.time_step, x_);
        problem_.enforce_thickness(std::clamp(share - pressed * (outside - share), 0.0, 1.0), stiffness_factor);
        const NewtonSummary summary = solve_step(t, tolerance, "settle", preview_iteration_cap);
        if (summary.end == NewtonEnd::cancelled) {
            x_ = before;
            return Outcome::cancelled;
        }
        const double share_before = std::exchange(share, problem_.least_thickness_share(x_));
        if (outside - share > 0.5 * (outside - share_before))
            stiffness_factor *= 4;
    }
    problem_.enforce_thickness(1, progress_.stiffness_factor);
    return outcome;
}

bool LevelStepper::timeline_is_over(double duration) const {
    return progress_.step >= timeline_steps(duration, settings_.time_step);
}

LevelStepper::Outcome LevelStepper::run_timeline(double duration) {
    Outcome worst = Outcome::done;
    if (progress_.step == 0)
        log_.frame(level_, 0, "preview", positions());
    while (!timeline_is_over(duration)) {
        const Outcome outcome = step_timeline(duration);
        if (outcome == Outcome::cancelled)
            return outcome;
        worst = std::max(worst, outcome);
    }
    return worst;
}

LevelStepper::Outcome LevelStepper::step_timeline(double duration) {
    const double h = settings_.time_step;
    const double t_before = std::min(progress_.step * h, duration);
    const double t = std::min((progress_.step + 1) * h, duration);
    const VecX before = x_;
    const VecX motion = progress_.velocity.cols() > 0 ? VecX(h * as_vector(progress_.velocity)) : VecX::Zero(x_.size());
    begin_step(t, h, settings_.dynamics ? VecX(x_ + motion) : x_);
    extrapolate(motion);
    const NewtonSummary summary = solve_pressed_step(t, settings_.tolerance, "preview", iteration_cap());
    if (summary.end == NewtonEnd::cancelled) {
        x_ = before;
        return Outcome::cancelled;
    }
    progress_.velocity = as_positions(VecX((x_ - before) / h));
    progress_.friction = problem_.friction_memory();
    ++progress_.step;
    const double interval = settings_.frame_interval;
    if (std::floor(t / interval + 1e-9) > std::floor(t_before / interval + 1e-9) || timeline_is_over(duration))
        log_.frame(level_, t, "preview", positions());
    save_checkpoint(t);
    return outcome_of(summary);
}

LevelStepper::Outcome LevelStepper::step_once(double t) {
    const VecX before = x_;
    begin_step(t, settings_.time_step, x_);
    const NewtonSummary summary =
        solve_pressed_step(t, settings_.tolerance, is_last_ ? "final" : "refine", iteration_cap());
    progress_.friction = problem_.friction_memory();
    if (summary.end == NewtonEnd::cancelled)
        x_ = before;
    return outcome_of(summary);
}

LevelStepper::Outcome LevelStepper::settle(double t) {
    while (progress_.settle_step < settings_.max_settle_steps)
        if (const Outcome outcome = step_settling(t); outcome != Outcome::cut_short)
            return outcome;
    return Outcome::cut_short;
}

LevelStepper::Outcome LevelStepper::step_settling(double t) {
    constexpr double largest_growth = 1e3;
    const VecX before = x_;
    const double h = progress_.settle_time_step;
    begin_settling_step(t, h);
    // A settling step is only a means: equilibrium is judged at its start, so it may always be cut short. But a
    // script that has not arrived in one is blocked, and that takes longer to find out.
    const int most = progress_.settle_step == 0 || scripts_have_arrived()
                         ? std::min(iteration_cap(), preview_iteration_cap)
                         : settings_.max_iterations_per_step.value_or(final_iteration_cap);
    const NewtonSummary summary = solve_pressed_step(t, progress_.settle_tolerance, "settle", most);
    if (summary.end == NewtonEnd::cancelled) {
        x_ = before;
        return Outcome::cancelled;
    }
    if (summary.end == NewtonEnd::blocked)
        return Outcome::stalled;
    ++progress_.settle_step;
    if (summary.end == NewtonEnd::converged) { // else contacts may be on a way that they have yet to take back
        problem_.remember_friction(x_);
        progress_.friction = problem_.friction_memory();
    }
    const bool at_rest = summary.end == NewtonEnd::converged && summary.iterations == 0;
    if (at_rest && problem_.residual(x_) <= largest_residual) {
        log_.level_report(level_).equilibrium = true;
        return Outcome::done;
    }
    if (at_rest)
        progress_.settle_tolerance *= 0.1;
    if (summary.end == NewtonEnd::stalled)
        progress_.settle_time_step = std::max(0.1 * h, 1e-3 * settings_.time_step);
    else if (summary.end == NewtonEnd::iteration_cap && problem_.friction_possible())
        progress_.settle_time_step = std::max(0.5 * h, 1e-3 * settings_.time_step); // lest it rubs to and fro
    else if (summary.iterations <= most / 2)
        progress_.settle_time_step = std::min(2 * h, largest_growth * settings_.time_step);
    save_checkpoint(t);
    return Outcome::cut_short;
}

void LevelStepper::save_checkpoint(double t) {
    progress_.t = t;
    progress_.positions = positions();
    measure();
    log_.checkpoint(progress_);
}

void LevelStepper::measure() {
    LevelReport& report = log_.level_report(level_);
    const EnergyBreakdown energies = problem_.energies(x_);
    report.energy = {energies.elastic,  energies.strain_limit, energies.contact,
                     energies.friction, energies.gravity,      energies.loads};
    report.residual = problem_.residual(x_);
    report.min_gap = problem_.min_gap(x_);
    report.max_stretch = problem_.max_stretch(x_);
    report.too_coarse =
        find_too_coarse(discretization_.mesh(level_).rest, positions(), discretization_.layout(level_).body_faces);
    PhaseTimes& now = log_.context().times;
    report.total_seconds += watch_.seconds();
    watch_ = Stopwatch();
    double known = 0;
    for (int p = 0; p < phase_count; ++p) {
        const auto phase = static_cast<std::size_t>(p);
        report.seconds.seconds[phase] += now.seconds[phase] - times_at_start_.seconds[phase];
        known += report.seconds.seconds[phase];
    }
    times_at_start_ = now;
    report.seconds[Phase::other] += std::max(0.0, report.total_seconds - known);
}

} // namespace plisse
