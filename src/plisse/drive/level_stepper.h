#pragma once

#include <string>
#include <string_view>

#include <plisse/drive/run_log.h>
#include <plisse/model/shell_problem.h>
#include <plisse/solve/newton.h>

namespace plisse {

/// Steps one level: through the timeline (PSQ algorithm 1) and, with parameters held, to equilibrium.
class LevelStepper {
public:
    enum class Outcome { done, cut_short, stalled, cancelled };

    /// is_last: this level's result is the run's, so its steps may not be cut short unless the scene says so.
    LevelStepper(const Discretization& discretization, int level, EnergiesOf energies_of, bool is_last, RunLog& log);

    /// Takes up a run where a checkpoint left it (or at the start of a level).
    void start_from(const Checkpoint& progress);
    Positions positions() const { return as_positions(x_); }
    Checkpoint& progress() { return progress_; }
    const Checkpoint& progress() const { return progress_; }

    /// Moves surfaces that are nearer than their contact thickness apart until none is, by steps at time t in which
    /// only a growing share of it is enforced, with a barrier that stiffens where the loads are too strong for it.
    /// `cut_short` when that does not succeed.
    Outcome bring_to_thickness(double t);

    /// Runs the timeline from progress().step on, saving frames and checkpoints. `done` when no step failed.
    Outcome run_timeline(double duration);
    bool timeline_is_over(double duration) const;
    /// The next step of the timeline, which is not over.
    Outcome step_timeline(double duration);

    /// Steps at time t until equilibrium (CONTRACT.md, "A state is at equilibrium when"), with time steps that grow as
    /// long as the solver copes: they only regularise. `cut_short` when max_settle_steps were not enough.
    Outcome settle(double t);
    /// The next step of that: `done` at equilibrium, `cut_short` on the way there, `stalled` when a script is blocked.
    Outcome step_settling(double t);

    /// One step at time t, as a level gets that is not to settle.
    Outcome step_once(double t);

    /// Why the last step that was cut short or stalled was so, in words; empty where none was.
    const std::string& trouble() const { return trouble_; }

    /// Brings the level's part of the report up to date.
    void measure();

    ShellProblem& problem() { return problem_; }
    const VecX& unknowns() const { return x_; }

private:
    void begin_step(double t, double h, const VecX& anchor);
    void begin_settling_step(double t, double h);
    bool scripts_have_arrived();
    /// Starts the step where the last step's motion leads, with scripts fulfilled, unless something is in the way or
    /// the script alone leads to a lower value.
    void extrapolate(const VecX& motion);
    NewtonSummary solve_step(double t, double tolerance, const char* phase, int most_iterations);
    /// The same, and again for as long as the normal forces that friction goes by change what it finds.
    NewtonSummary solve_rubbing_step(double t, double tolerance, const char* phase, int most_iterations);
    /// The same. Where it ends with surfaces pressed so tightly that the barrier is ill-conditioned, it stiffens the
    /// barrier, for all that follows on this level and the next ones, and solves on (docs/decisions/0017).
    NewtonSummary solve_pressed_step(double t, double tolerance, const char* phase, int most_iterations);
    void set_stiffness_factor(double factor);
    void stiffen_barrier(double t, const TightestPair& tightest);
    void tell_stiffness(double t, const TightestPair& tightest, std::string_view change);
    void save_checkpoint(double t);
    int iteration_cap() const;
    double fraction(std::string_view phase) const;

    const Discretization& discretization_;
    const SolveSettings& settings_;
    int level_;
    bool is_last_;
    RunLog& log_;
    ShellProblem problem_;
    LinearSolver solver_;
    VecX x_;
    Checkpoint progress_;
    std::string trouble_;
    PhaseTimes times_at_start_;
    Stopwatch watch_;
};

} // namespace plisse
