#pragma once

#include <optional>

#include <plisse/drive/level_stepper.h>
#include <plisse/drive/run.h>

namespace plisse {

/// A run of the methods progressive or direct in its stages, for drivers that decide between steps what comes next:
/// steps on a level (by stepper()), the end of a level, the refinement to the next.
class StagedRun {
public:
    /// Makes the hierarchy, and begins on the first level, or where options.resume left off. Throws InputError as run()
    /// does. Recorder and context must outlive it.
    StagedRun(const Model& model, const RunOptions& options, Recorder& recorder, Context& context);

    const Discretization& discretization() const { return discretization_; }
    int first_level() const { return first_level_; }
    int last_level() const { return last_level_; }
    int level() const { return stepper_->progress().level; }
    double duration() const { return duration_; }          ///< s of the timeline that are run
    double time() const { return stepper_->progress().t; } ///< s of the timeline, of the present state
    LevelStepper& stepper() { return *stepper_; }
    RunReport& report() { return log_.report(); }
    RunLog& log() { return log_; }

    /// Moves surfaces apart that are nearer than their contact thickness, where the level has yet to take its first
    /// step. False when it is cancelled or does not succeed.
    bool bring_to_thickness();
    /// Ends the level at its last step: measures it, and saves a frame and a checkpoint.
    void conclude_level();
    /// Takes the last state of the level to the next one, and goes on there at the same time of the timeline. False
    /// when it is cancelled or not complete; then the run stays where it was.
    bool refine();
    /// Ends the run after the last level: what became of scripts and previews goes into the report.
    void finish();
    /// Notes what kept the run from being converged. The first status stays.
    void fail(RunStatus status, const std::string& message);
    RunResult result();

    /// What restore() needs to come back to the last completed step, in every bit.
    Checkpoint state();
    /// Goes on from a state of this run, perhaps on another level, with the parameters of this model if one is given.
    void restore(const Checkpoint& state, std::optional<Model> model = std::nullopt);
    /// Goes on with other parameters, as Discretization::set_model takes them. The timeline goes on at the time
    /// reached.
    void set_model(Model model);

private:
    void take(Model model);
    void enter(const Checkpoint& progress);
    void check_start(const Positions& x) const;
    void check_limits(int level, const Positions& x) const;
    void find_lagging();
    void find_preview_distances();
    std::vector<Reaction> reactions();
    Checkpoint fresh_progress(int level, double t, const Positions& x) const;
    const Model& model() const { return discretization_.model(); }

    Recorder& recorder_;
    Context& context_;
    double until_;
    Discretization discretization_;
    double duration_;
    RunLog log_;
    int first_level_, last_level_;
    std::optional<LevelStepper> stepper_;
};

} // namespace plisse
