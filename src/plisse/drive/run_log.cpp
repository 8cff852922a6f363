#include <plisse/drive/run_log.h>

#include <algorithm>

#include <plisse/spatial/intersections.h>

namespace plisse {

RunLog::RunLog(const Hierarchy& levels, int body_count, std::vector<FoldScale> scales, Recorder& recorder,
               Context& context, RunReport report)
    : hierarchy_(levels), body_count_(body_count), scales_(std::move(scales)), recorder_(recorder), context_(context),
      report_(std::move(report)), frame_numbers_(levels.levels.size(), 0), earlier_seconds_(report_.wall_seconds) {}

LevelReport& RunLog::level_report(int level) {
    auto& levels = report_.levels;
    const auto found = std::find_if(levels.begin(), levels.end(), [&](const auto& l) { return l.level == level; });
    if (found != levels.end())
        return *found;
    LevelReport fresh;
    fresh.level = level;
    fresh.vertices = static_cast<int>(mesh(level).rest.cols());
    fresh.faces = static_cast<int>(mesh(level).faces.size());
    fresh.estimated_turn = estimate_level(mesh(level), scales_).turn;
    levels.push_back(fresh);
    return levels.back();
}

void RunLog::frame(int level, double t, const std::string& phase, const Positions& x) {
    const HierarchyLevel& shown = mesh(level);
    const auto of_obstacle = [&](int f) {
        const int corner = shown.faces[static_cast<std::size_t>(f)][0];
        return shown.part[static_cast<std::size_t>(corner)] >= body_count_;
    };
    const auto both_obstacles = [&](int a, int b) { return of_obstacle(a) && of_obstacle(b); };
    report_.intersecting_pairs += static_cast<int>(intersecting_pairs(x, shown.faces, both_obstacles).size());
    recorder_.on_frame({level, frame_numbers_[static_cast<std::size_t>(level)]++, t, phase, &x});
}

void RunLog::checkpoint(Checkpoint checkpoint) {
    report_.wall_seconds = seconds();
    checkpoint.frame_numbers = frame_numbers_;
    checkpoint.report = report_;
    recorder_.on_checkpoint(checkpoint);
    recorder_.on_report(report_);
}

void RunLog::publish() {
    report_.wall_seconds = seconds();
    recorder_.on_report(report_);
}

} // namespace plisse
