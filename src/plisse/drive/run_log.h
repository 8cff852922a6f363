#pragma once

#include <plisse/base/context.h>
#include <plisse/drive/recorder.h>
#include <plisse/model/fold_estimate.h>

namespace plisse {

/// Everything a run tells the outside while it goes on: frames, iterations, checkpoints and the report, kept in one
/// place so that drivers only say what happened.
class RunLog {
public:
    /// levels: what frames show; must outlive the log. Parts from body_count on are obstacles. scales: governing_scales
    /// of the bodies, for the estimate of each level.
    RunLog(const Hierarchy& levels, int body_count, std::vector<FoldScale> scales, Recorder& recorder, Context& context,
           RunReport report);

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
    const HierarchyLevel& mesh(int level) const { return hierarchy_.levels[static_cast<std::size_t>(level)]; }

    const Hierarchy& hierarchy_;
    int body_count_;
    std::vector<FoldScale> scales_;
    Recorder& recorder_;
    Context& context_;
    RunReport report_;
    std::vector<int> frame_numbers_;
    double earlier_seconds_;
    Stopwatch watch_;
};

} // namespace plisse
