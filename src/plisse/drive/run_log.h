#pragma once

#include <plisse/base/context.h>
#include <plisse/drive/recorder.h>
#include <plisse/model/shell_problem.h>

namespace plisse {

/// Everything a run tells the outside while it goes on: frames, iterations, checkpoints and the report, kept in one
/// place so that drivers only say what happened.
class RunLog {
public:
    RunLog(const Discretization& discretization, Recorder& recorder, Context& context, RunReport report);

    Context& context() { return context_; }
    RunReport& report() { return report_; }
    LevelReport& level_report(int level);

    /// Numbers of the next frame of each level.
    const std::vector<int>& frame_numbers() const { return frame_numbers_; }
    void restore_frame_numbers(const std::vector<int>& numbers) { frame_numbers_ = numbers; }

    /// Saves a frame and adds its intersecting pairs, found with exact predicates, to the report.
    void frame(int level, double t, const std::string& phase, const Positions& x);
    void iteration(const IterationRecord& record) { recorder_.on_iteration(record); }
    void stiffening(const StiffeningRecord& record) { recorder_.on_stiffening(record); }
    void checkpoint(Checkpoint checkpoint);
    /// Writes the report as it stands.
    void publish();

    double seconds() const { return earlier_seconds_ + watch_.seconds(); }

private:
    const Discretization& discretization_;
    Recorder& recorder_;
    Context& context_;
    RunReport report_;
    std::vector<int> frame_numbers_;
    double earlier_seconds_;
    Stopwatch watch_;
};

} // namespace plisse
