#include "saved_animation.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <tuple>

#include <fmt/core.h>

#include <plisse/base/error.h>

namespace plisse {

namespace {

namespace fs = std::filesystem;

std::map<int, int> count_frames(const SavedRun& run) {
    std::map<int, int> counts;
    for (const SavedFrame& frame : run.frames)
        ++counts[frame.level];
    return counts;
}

int choose_level(const SavedRun& run, int wanted) {
    const std::map<int, int> counts = count_frames(run);
    if (counts.empty())
        throw InputError(run.folder.string(), "the run has saved no frames",
                         "run it without --no-frames, or give --final for its last state");
    if (wanted < 0)
        return std::max_element(counts.begin(), counts.end(),
                                [](const auto& a, const auto& b) {
                                    return std::tie(a.second, a.first) < std::tie(b.second, b.first);
                                })
            ->first;
    if (!counts.contains(wanted)) {
        std::string levels;
        for (const auto& [level, count] : counts)
            levels += fmt::format("{}{} ({})", levels.empty() ? "" : ", ", level, count);
        throw InputError(run.folder.string(), fmt::format("level {} has no frames", wanted),
                         fmt::format("give one of the levels that have (how many): {}", levels));
    }
    return wanted;
}

std::vector<SavedFrame> choose_frames(const SavedRun& run, const AnimationChoice& choice) {
    if (choice.final_only) {
        if (!run.final_state)
            throw InputError((run.folder / "final.ply").string(), "it is missing",
                             "let the run end, or leave out --final to export its frames");
        return {*run.final_state};
    }
    const int level = choose_level(run, choice.level);
    std::vector<SavedFrame> all, kept;
    std::copy_if(run.frames.begin(), run.frames.end(), std::back_inserter(all),
                 [level](const SavedFrame& frame) { return frame.level == level; });
    for (std::size_t k = 0; k < all.size(); ++k)
        if (k % static_cast<std::size_t>(choice.every) == 0 || k + 1 == all.size())
            kept.push_back(all[k]);
    return kept;
}

void expect_files(const std::vector<SavedFrame>& frames) {
    for (const SavedFrame& frame : frames)
        if (!fs::is_regular_file(frame.file))
            throw InputError(frame.file.string(), "the frame is missing",
                             "restore it, export another --level, or run the scene again");
}

/// The median time from a frame to the next.
double usual_interval(const std::vector<SavedFrame>& frames) {
    std::vector<double> gaps;
    for (std::size_t k = 1; k < frames.size(); ++k)
        if (frames[k].t > frames[k - 1].t)
            gaps.push_back(frames[k].t - frames[k - 1].t);
    if (gaps.empty())
        return 1.0 / 24;
    const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
    std::nth_element(gaps.begin(), middle, gaps.end());
    return *middle;
}

std::vector<double> playing_times(const std::vector<SavedFrame>& frames, double fps) {
    const double interval = usual_interval(frames);
    std::vector<double> times;
    for (const SavedFrame& frame : frames)
        if (fps > 0)
            times.push_back(static_cast<double>(times.size()) / fps);
        else
            times.push_back(times.empty() || frame.t > times.back() ? frame.t : times.back() + interval);
    return times;
}

} // namespace

SavedAnimation open_animation(const SavedRun& run, const AnimationChoice& choice) {
    const std::vector<SavedFrame> frames = choose_frames(run, choice);
    expect_files(frames);
    const BodyMesh first = read_body_mesh(frames.front().file);

    Animation animation;
    animation.name = run.name;
    animation.parts = run.body_names;
    for (int body : first.face_body)
        if (body >= static_cast<int>(animation.parts.size()))
            throw InputError(frames.front().file.string(), fmt::format("it has a face of body {}", body),
                             fmt::format("the scene has {} bodies and obstacles", animation.parts.size()));
    animation.face_part = first.face_body;
    animation.times = playing_times(frames, choice.fps);
    animation.state = [frames, faces = first.mesh.faces, vertices = first.mesh.vertex_count()](std::size_t k) {
        TriangleMesh state = read_body_mesh(frames.at(k).file).mesh;
        if (state.faces != faces || state.vertex_count() != vertices)
            throw InputError(frames[k].file.string(), "it is not of the same mesh as " + frames.front().file.string(),
                             "run the scene again");
        return state;
    };
    return {frames.front().level, std::move(animation)};
}

} // namespace plisse
