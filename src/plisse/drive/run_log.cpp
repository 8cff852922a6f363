#include <plisse/drive/run_log.h>

#include <algorithm>

#include <plisse/model/fold_estimate.h>
#include <plisse/spatial/intersections.h>

namespace plisse {

RunLog::RunLog(const Discretization& discretization, Recorder& recorder, Context& context, RunReport report)
    : discretization_(discretization), recorder_(recorder), context_(context), report_(std::move(report)),
      frame_numbers_(static_cast<std::size_t>(discretization.finest()) + 1, 0), earlier_seconds_(report_.wall_seconds) {
}

LevelReport& RunLog::level_report(int level) {
    auto& levels = report_.levels;
    const auto found = std::find_if(levels.begin(), levels.end(), [&](const auto& l) { return l.level == level; });
    if (found != levels.end())
        return *found;
    LevelReport fresh;
    fresh.level = level;
    fresh.vertices = static_cast<int>(discretization_.mesh(level).rest.cols());
    fresh.faces = static_cast<int>(discretization_.mesh(level).faces.size());
    fresh.estimated_turn = estimate_level(discretization_.mesh(level), governing_scales(discretization_.model())).turn;
    levels.push_back(fresh);
    return levels.back();
}

void RunLog::frame(int level, double t, const std::string& phase, const Positions& x) {
    const Model& model = discretization_.model();
    const std::vector<int>& part = discretization_.layout(level).face_part;
    const auto both_obstacles = [&](int a, int b) {
        return model.is_obstacle(part[static_cast<std::size_t>(a)]) &&
               model.is_obstacle(part[static_cast<std::size_t>(b)]);
    };
    report_.intersecting_pairs +=
        static_cast<int>(intersecting_pairs(x, discretization_.mesh(level).faces, both_obstacles).size());
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
