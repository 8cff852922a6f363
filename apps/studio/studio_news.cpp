// What pages are told.
#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <plisse/scene/json_writer.h>
#include <plisse/scene/material_presets.h>
#include <plisse/scene/write_scene.h>
#include <plisse/steer/edited_scene.h>

#include "studio.h"

namespace plisse::studio {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds status_interval{50};

Json number_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Json json_of(const Vec3& place) {
    return {place.x(), place.y(), place.z()};
}

Vec3 middle(const Positions& points, const std::vector<int>& vertices) {
    Vec3 sum = Vec3::Zero();
    for (int v : vertices)
        sum += points.col(v);
    return sum / std::max<double>(1, static_cast<double>(vertices.size()));
}

Vec3 middle(const Positions& points, const Range& vertices) {
    return points.middleCols(vertices.begin, vertices.size()).rowwise().mean();
}

/// Where the middle of each handle is now, and then of each obstacle.
std::vector<Vec3> script_places(StagedRun& run) {
    const Discretization& discretization = run.discretization();
    const Model& model = discretization.model();
    const std::vector<int>& part = discretization.mesh(run.level()).part;
    const Positions x = run.stepper().positions();
    std::vector<Vec3> places(model.handles.size() + model.obstacles.size(), Vec3::Zero());
    std::vector<int> counts(places.size(), 0);
    const auto add = [&](std::size_t script, int v) {
        places[script] += x.col(v);
        ++counts[script];
    };
    for (int v = 0; v < x.cols(); ++v) {
        for (int h : discretization.handles_of(run.level(), v))
            add(static_cast<std::size_t>(h), v);
        if (const int p = part[static_cast<std::size_t>(v)]; model.is_obstacle(p))
            add(model.handles.size() + static_cast<std::size_t>(p) - model.bodies.size(), v);
    }
    for (std::size_t script = 0; script < places.size(); ++script)
        places[script] /= std::max(counts[script], 1);
    return places;
}

} // namespace

void Studio::set_state(State state) {
    state_ = state;
    tell_status();
}

void Studio::tell_scene() {
    Json json = {{"type", "session"},
                 {"scene", scene_to_json(session_->scene())},
                 {"presets", Json::object()},
                 {"live", Json::array()},
                 {"edited", !session_->edits().empty()},
                 {"can_undo", session_->can_undo()},
                 {"can_redo", session_->can_redo()},
                 {"file_name", file_name_}};
    for (const MaterialPreset& preset : material_presets())
        if (preset.material.law == MaterialLaw::isotropic)
            json["presets"][preset.name] = ObjectWriter::write(preset.material);
    for (const std::string& pointer : live_pointers())
        json["live"].push_back(pointer);
    board_.tell("session", json.dump());
}

void Studio::tell_status(bool now) {
    static constexpr const char* names[] = {"empty", "building", "idle", "playing", "refining", "at_rest", "failed"};
    if (!now && Clock::now() - last_status_ < status_interval)
        return;
    last_status_ = Clock::now();
    Json json = {{"type", "status"}, {"state", names[static_cast<std::size_t>(state_)]}, {"message", message_}};
    if (session_) {
        StagedRun& run = session_->run();
        const Checkpoint& progress = run.stepper().progress();
        json.update({{"level", run.level()},
                     {"levels", run.last_level() + 1},
                     {"vertices", run.discretization().mesh(run.level()).rest.cols()},
                     {"phase", session_->timeline_is_over() ? "settle" : "preview"},
                     {"t", progress.t},
                     {"duration", run.duration()},
                     {"step", session_->steps()},
                     {"equilibrium", session_->is_at_rest()},
                     {"intersecting_pairs", run.report().intersecting_pairs},
                     {"steps_per_second", step_rate_.per_second(last_status_)},
                     {"edit_to_step_ms", edit_to_step_ms_}});
    }
    board_.tell("status", json.dump());
}

void Studio::tell_sample(double seconds, int iterations) {
    StagedRun& run = session_->run();
    const LevelReport& level = run.log().level_report(run.level());
    const EnergyParts& e = level.energy;
    const Json json = {{"type", "sample"},
                       {"level", level.level},
                       {"t", run.stepper().progress().t},
                       {"step", level.steps},
                       {"energy", e.elastic + e.strain_limit + e.contact + e.friction + e.gravity + e.loads},
                       {"residual", level.residual},
                       {"gap", number_or_null(level.min_gap)},
                       {"iterations", iterations},
                       {"seconds", seconds}};
    board_.add_sample(json.dump());
}

void Studio::tell_parts() {
    StagedRun& run = session_->run();
    const Discretization& discretization = run.discretization();
    const Model& model = discretization.model();
    const std::vector<Vec3> places = script_places(run);
    Json json = {{"type", "parts"},
                 {"parts", Json::array()},
                 {"handles", Json::array()},
                 {"obstacles", Json::array()},
                 {"pulls", Json::array()}};
    for (const Body& body : model.bodies)
        json["parts"].push_back({{"name", body.name}, {"kind", "body"}});
    for (const Obstacle& obstacle : model.obstacles)
        json["parts"].push_back({{"name", obstacle.name}, {"kind", "obstacle"}});
    for (std::size_t h = 0; h < model.handles.size(); ++h)
        json["handles"].push_back({{"name", model.handles[h].name},
                                   {"place", json_of(places[h])},
                                   {"rest", json_of(middle(model.start, model.handles[h].vertices))}});
    for (std::size_t o = 0; o < model.obstacles.size(); ++o)
        json["obstacles"].push_back({{"name", model.obstacles[o].name},
                                     {"place", json_of(places[model.handles.size() + o])},
                                     {"rest", json_of(middle(model.mesh.positions, model.obstacles[o].vertices))}});
    const Positions& fine = run.stepper().problem().carried(run.stepper().unknowns());
    const bool is_fine = fine.cols() == model.mesh.vertex_count();
    for (const Pull& pull : model.pulls) {
        if (pull.points.empty())
            continue;
        const Vec3 to = pull.points.front().to.at(run.duration());
        const Vec3 from = is_fine ? Vec3(fine.col(pull.points.front().vertex)) : to;
        json["pulls"].push_back({{"id", pull.name}, {"at", json_of(from)}, {"to", json_of(to)}});
    }
    board_.tell("parts", json.dump());
}

void Studio::show_all() {
    const Board::Picture plain = projector_.picture(session_->run(), {});
    board_.set_picture(plain);
    for (ClientId client : board_.clients()) {
        if (scrubbing_.contains(client))
            continue;
        const auto asked = shows_.find(client);
        if (asked == shows_.end())
            board_.show(client, plain);
        else
            board_.show(client, projector_.picture(session_->run(), asked->second));
    }
}

} // namespace plisse::studio
