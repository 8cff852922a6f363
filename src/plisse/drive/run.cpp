#include <plisse/drive/run.h>

#include <fmt/format.h>

#include <plisse/drive/staged_run.h>

namespace plisse {

namespace {

using Outcome = LevelStepper::Outcome;

/// Timeline (first level only), then equilibrium. False when the run cannot or shall not go on.
bool run_level(StagedRun& run, const SolveSettings& solve) {
    LevelStepper& stepper = run.stepper();
    const int level = run.level();
    if (!run.bring_to_thickness())
        return false;
    if (level == run.first_level() && stepper.progress().settle_step == 0) {
        const Outcome outcome = stepper.run_timeline(run.duration());
        if (outcome == Outcome::cancelled)
            return false;
        if (outcome != Outcome::done && level == run.last_level())
            run.fail(RunStatus::not_converged,
                     fmt::format("a step of the timeline {} ({})",
                                 outcome == Outcome::stalled ? "stalled" : "was cut short", stepper.trouble()));
    }
    const Outcome outcome = solve.settle                 ? stepper.settle(run.duration())
                            : level == run.first_level() ? Outcome::done
                                                         : stepper.step_once(run.duration());
    if (outcome == Outcome::cancelled)
        return false;
    if (outcome != Outcome::done && (solve.settle || level == run.last_level()))
        run.fail(RunStatus::not_converged,
                 fmt::format("level {} did not reach equilibrium{}", level,
                             stepper.trouble().empty() ? "" : " (" + stepper.trouble() + ")"));
    run.conclude_level();
    return true;
}

/// Steps the timeline on the first level, then refines level by level to the last; `direct` has one level only. True
/// when the last level was reached and stepped.
bool run_stages(StagedRun& run, const SolveSettings& solve) {
    for (;;) {
        if (!run.stepper().progress().settled && !run_level(run, solve))
            return false;
        if (run.level() == run.last_level()) {
            run.finish();
            return true;
        }
        if (!run.refine())
            return false;
    }
}

} // namespace

RunResult run(const Model& model, const RunOptions& options, Recorder& recorder, Context& context) {
    StagedRun run(model, options, recorder, context);
    if (!run_stages(run, model.solve) && run.report().status == RunStatus::running)
        run.fail(RunStatus::interrupted, "interrupted");
    run.log().publish();
    return run.result();
}

} // namespace plisse
