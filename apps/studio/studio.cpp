#include "studio.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/scene/json_writer.h>
#include <plisse/scene/material_presets.h>
#include <plisse/scene/read_scene.h>
#include <plisse/scene/write_scene.h>
#include <plisse/steer/edited_scene.h>
#include <plisse/steer/replay.h>

#include "scene_files.h"

namespace plisse::studio {

namespace {

using Json = nlohmann::ordered_json;
using std::chrono::duration;
using std::chrono::milliseconds;

constexpr milliseconds status_interval{50}, progress_interval{100};
constexpr std::size_t step_window = 40; ///< steps over which their rate is taken

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return duration<double>(to - from).count();
}

Json number_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

/// Whether the command makes worthless what the solver is at.
struct CutsShort {
    bool steps_are_long;
    bool operator()(const OpenScene&) const { return true; }
    bool operator()(const Undo&) const { return true; }
    bool operator()(const Redo&) const { return true; }
    bool operator()(const Stop&) const { return true; }
    bool operator()(const Preview&) const { return true; }
    bool operator()(const Restart&) const { return true; }
    bool operator()(const SetValues&) const { return steps_are_long; }
    bool operator()(const Grab&) const { return steps_are_long; }
    template <typename Other>
    bool operator()(const Other&) const {
        return false;
    }
};

Json middle(const Positions& points, const std::vector<int>& vertices) {
    Vec3 sum = Vec3::Zero();
    for (int v : vertices)
        sum += points.col(v);
    const Vec3 mean = sum / std::max<double>(1, static_cast<double>(vertices.size()));
    return {mean.x(), mean.y(), mean.z()};
}

Json middle(const Positions& points, const Range& vertices) {
    const Vec3 mean = points.middleCols(vertices.begin, vertices.size()).rowwise().mean();
    return {mean.x(), mean.y(), mean.z()};
}

bool same_places(const SetValues& a, const SetValues& b) {
    return std::equal(a.edits.begin(), a.edits.end(), b.edits.begin(), b.edits.end(),
                      [](const SceneEdit& one, const SceneEdit& other) { return one.pointer == other.pointer; });
}

/// Whether the second of two commands in a row leaves nothing of the first.
bool supersedes(const Command& first, const Command& second) {
    if (const auto* grab = std::get_if<Grab>(&first))
        if (const auto* next = std::get_if<Grab>(&second))
            return grab->id == next->id && grab->vertex == next->vertex;
    if (const auto* values = std::get_if<SetValues>(&first))
        if (const auto* next = std::get_if<SetValues>(&second))
            return !values->gesture.empty() && values->gesture == next->gesture && same_places(*values, *next);
    return false;
}

} // namespace

Studio::Studio(std::filesystem::path folder) : folder_(std::move(folder)) {
    if (const auto caches = HierarchyCache::default_folder())
        cache_.emplace(*caches, static_cast<Context&>(*this));
}

Studio::~Studio() {
    stop();
}

void Studio::start(Server& server) {
    board_.connect(server);
    set_state(State::empty);
    thread_ = std::thread([this] { work(); });
}

void Studio::stop() {
    tasks_.close();
    if (thread_.joinable())
        thread_.join();
}

void Studio::open(const std::filesystem::path& path) {
    const Scene scene = read_scene(path); // here, so that the command line hears what is wrong with it
    tasks_.post({0, std::nullopt, [this, scene] { begin(scene, scene.name, State::idle); }, Clock::now()}, true);
}

// ---- from pages

void Studio::on_join(ClientId client) {
    board_.join(client);
}

void Studio::on_leave(ClientId client) {
    board_.leave(client);
    const auto forget = [this, client] {
        shows_.erase(client);
        scrubbing_.erase(client);
    };
    tasks_.post({client, std::nullopt, forget, Clock::now()}, false);
}

void Studio::on_message(ClientId client, std::string_view text) {
    auto parsed = parse_command(text);
    if (const auto* refused = std::get_if<NotACommand>(&parsed)) {
        board_.answer(client, error_message(*refused));
        return;
    }
    Command command = std::get<Command>(std::move(parsed));
    const bool cuts_short = std::visit(CutsShort{steps_are_long_}, command);
    tasks_.post({client, std::move(command), {}, Clock::now()}, cuts_short);
}

// ---- the thread

void Studio::work() {
    while (!tasks_.is_closed()) {
        do_tasks(tasks_.take(!is_at_work()));
        if (!is_at_work() || tasks_.is_closed())
            continue;
        try {
            advance();
        } catch (const std::exception& error) {
            message_ = error.what();
            set_state(State::failed);
        }
    }
}

void Studio::do_tasks(std::vector<Task> tasks) {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const bool last = i + 1 == tasks.size();
        if (last || !tasks[i].command || !tasks[i + 1].command || !supersedes(*tasks[i].command, *tasks[i + 1].command))
            do_task(tasks[i]);
    }
}

void Studio::do_task(const Task& task) {
    arrival_ = task.arrival;
    try {
        if (task.command)
            std::visit([&](const auto& command) { perform(task.client, command); }, *task.command);
        else
            task.work();
    } catch (const std::exception& error) {
        frames_.clear();
        if (state_ == State::building)
            set_state(session_ ? State::idle : State::empty);
        const Json answer = {{"type", "error"}, {"message", error.what()}, {"in_answer_to", ""}};
        if (task.client != 0)
            board_.answer(task.client, answer.dump());
        else
            board_.mention(answer.dump());
    }
}

void Studio::advance() {
    if (state_ == State::refining && session_->is_at_rest() && session_->run().level() < refine_to_)
        refine_once();
    else
        take_step();
}

void Studio::take_step() {
    const auto begin = Clock::now();
    StagedRun& run = session_->run();
    const int iterations_before = run.log().level_report(run.level()).newton_iterations;
    const Session::StepEnd end = session_->step();
    if (end == Session::StepEnd::cancelled)
        return;
    const auto now = Clock::now();
    step_times_.push_back(now);
    if (step_times_.size() > step_window)
        step_times_.pop_front();
    tell_sample(seconds_between(begin, now), run.log().level_report(run.level()).newton_iterations - iterations_before);
    if (end == Session::StepEnd::stepped && run.level() == 0 && session_->timeline_is_over())
        keep_settling_step();
    keep_frames();
    show_all();
    if (edit_arrival_) {
        edit_to_step_ms_ = 1e3 * seconds_between(*edit_arrival_, Clock::now());
        edit_arrival_.reset();
    }
    if (end != Session::StepEnd::stepped)
        return end_of_level(end);
    tell_status(false);
}

void Studio::end_of_level(Session::StepEnd end) {
    const bool settled = end == Session::StepEnd::at_rest;
    message_ = settled ? "" : "equilibrium was not reached: " + session_->run().stepper().trouble();
    if (state_ == State::refining && session_->run().level() < refine_to_)
        return refine_once();
    set_state(settled ? State::at_rest : State::idle);
    tell_parts();
}

void Studio::refine_once() {
    std::string reason;
    if (session_->refine(reason)) {
        steps_are_long_ = true;
        keep_frames();
        show_all();
        tell_parts();
        tell_scene();
        tell_status();
        return;
    }
    if (cancelled())
        return;
    message_ = reason;
    set_state(State::idle);
}

// ---- what a session tells

/// Frames wait until what they belong to has come to be: a run that is being begun may yet fail.
void Studio::on_frame(const Frame& frame) {
    frames_.push_back({frame.level, frame.t, frame.phase, std::make_shared<const Positions>(*frame.positions)});
}

/// The timeline is over, yet a body that is steered still moves.
void Studio::keep_settling_step() {
    StagedRun& run = session_->run();
    if (frames_.empty())
        frames_.push_back({run.level(), run.stepper().progress().t, "settle",
                           std::make_shared<const Positions>(run.stepper().positions())});
}

void Studio::keep_frames() {
    for (NewFrame& frame : std::exchange(frames_, {})) {
        const Json json = {
            {"index", board_.frame_count()}, {"level", frame.level}, {"t", frame.t}, {"phase", frame.phase}};
        const Board::Picture picture =
            projector_.saved(session_->run().discretization(), frame.level, frame.t, *frame.positions);
        board_.add_frame({json.dump(), picture, frame.level, frame.t, std::move(frame.positions)});
    }
    session_->marks = {board_.frame_count(), board_.sample_count()};
}

void Studio::on_progress(const Progress& progress) {
    const auto now = Clock::now();
    if (now - last_progress_ < progress_interval || state_ == State::playing)
        return;
    last_progress_ = now;
    const std::string text =
        progress.phase == "refine"
            ? fmt::format("level {}: undoing collapses, batch {}", progress.level, progress.step)
            : fmt::format("level {}: step {}, iteration {}", progress.level, progress.step, progress.iteration);
    board_.mention(Json{{"type", "progress"}, {"fraction", progress.fraction}, {"text", text}}.dump());
}

void Studio::on_message(const std::string& message) {
    message_ = message;
}

// ---- what pages are told

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
                     {"steps_per_second", steps_per_second()},
                     {"edit_to_step_ms", edit_to_step_ms_}});
    }
    board_.tell("status", json.dump());
}

double Studio::steps_per_second() {
    const auto now = Clock::now();
    while (!step_times_.empty() && seconds_between(step_times_.front(), now) > 3)
        step_times_.pop_front();
    if (step_times_.size() < 2)
        return 0;
    return static_cast<double>(step_times_.size() - 1) / seconds_between(step_times_.front(), step_times_.back());
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
    const HierarchyLevel& mesh = discretization.mesh(run.level());
    const Positions x = run.stepper().positions();
    std::vector<Vec3> sums(model.handles.size() + model.obstacles.size(), Vec3::Zero());
    std::vector<int> counts(sums.size(), 0);
    const auto add = [&](std::size_t script, int v) {
        sums[script] += x.col(v);
        ++counts[script];
    };
    for (int v = 0; v < x.cols(); ++v) {
        for (int h : discretization.handles_of(run.level(), v))
            add(static_cast<std::size_t>(h), v);
        if (const int part = mesh.part[static_cast<std::size_t>(v)]; model.is_obstacle(part))
            add(model.handles.size() + static_cast<std::size_t>(part) - model.bodies.size(), v);
    }
    const auto place = [&](std::size_t script) -> Json {
        const Vec3 mean = sums[script] / std::max(counts[script], 1);
        return {mean.x(), mean.y(), mean.z()};
    };
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
                                   {"place", place(h)},
                                   {"rest", middle(model.start, model.handles[h].vertices)}});
    for (std::size_t o = 0; o < model.obstacles.size(); ++o)
        json["obstacles"].push_back({{"name", model.obstacles[o].name},
                                     {"place", place(model.handles.size() + o)},
                                     {"rest", middle(model.mesh.positions, model.obstacles[o].vertices)}});
    const Positions& fine = run.stepper().problem().carried(run.stepper().unknowns());
    const bool is_fine = fine.cols() == model.mesh.vertex_count();
    for (const Pull& pull : model.pulls) {
        if (pull.points.empty())
            continue;
        const Vec3 to = pull.points.front().to.at(run.duration());
        const Vec3 from = is_fine ? Vec3(fine.col(pull.points.front().vertex)) : to;
        json["pulls"].push_back(
            {{"id", pull.name}, {"at", {from.x(), from.y(), from.z()}}, {"to", {to.x(), to.y(), to.z()}}});
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

// ---- commands

Session& Studio::session() {
    if (!session_)
        throw InputError("studio", "there is no scene", "open one first");
    return *session_;
}

void Studio::begin(const Scene& scene, const std::string& name, State next) {
    set_state(State::building);
    message_.clear();
    Scene plain = scene;
    plain.edits.reset();
    RunOptions options;
    options.hierarchies = cache_ ? &*cache_ : nullptr;
    Recorder& recorder = *this;
    Context& context = *this;
    session_ = std::make_unique<Session>(plain, EditLog(), options, recorder, context);
    file_name_ = is_plain_name(name) ? name : "scene";
    scrubbing_.clear();
    step_times_.clear();
    begin_anew();
    if (scene.edits) {
        follow(*session_, read_edit_log(scene.folder / *scene.edits));
        keep_frames();
        show_session();
    }
    set_state(next);
}

/// The session has begun another run.
void Studio::begin_anew() {
    projector_.begin_run();
    board_.cut_samples(0);
    board_.cut_frames(0);
    keep_frames();
    show_session();
}

/// The session has gone to another of its states.
void Studio::jump() {
    projector_.begin_run();
    board_.cut_frames(session_->marks.frames);
    board_.cut_samples(session_->marks.samples);
    show_session();
    set_state(State::idle);
}

/// Pages learn all that may be other than before.
void Studio::show_session() {
    steps_are_long_ = session_->run().level() > 0;
    hands_.clear();
    edit_arrival_.reset();
    tell_scene();
    tell_parts();
    show_all();
}

void Studio::perform(ClientId, const OpenScene& open) {
    const GalleryScene* scene = find_gallery_scene(open.gallery);
    if (!scene)
        throw InputError("gallery", fmt::format("there is no scene \"{}\"", open.gallery), "take one of the list");
    begin(parse_scene(scene->id + ".json", scene->text, folder_.files()), scene->id, State::idle);
}

void Studio::perform(ClientId, const Play&) {
    if (session().is_at_rest())
        return tell_status();
    message_.clear();
    set_state(State::playing);
}

void Studio::perform(ClientId, const Pause&) {
    edit_arrival_.reset();
    if (is_at_work())
        set_state(State::idle);
}

void Studio::perform(ClientId, const Step&) {
    set_state(session().is_at_rest() ? State::at_rest : State::idle);
    if (!session().is_at_rest())
        take_step();
    tell_status();
}

void Studio::set(const std::vector<std::pair<std::string, Json>>& values, const std::string& gesture) {
    Scene edited = session().scene();
    for (const auto& [pointer, value] : values)
        edited = edited_scene(edited, pointer, value);
    expect_no_other_files(edited, files_of(session().scene()), folder_.files());
    const bool goes_on = session().set(values, gesture);
    message_.clear();
    if (goes_on) {
        if (state_ == State::at_rest)
            state_ = State::playing;
        if (is_at_work() && !edit_arrival_)
            edit_arrival_ = arrival_;
        tell_scene();
        tell_status();
        return;
    }
    begin_anew();
    set_state(State::idle);
}

void Studio::perform(ClientId, const SetValues& values) {
    std::vector<std::pair<std::string, Json>> edits;
    for (const SceneEdit& edit : values.edits)
        edits.emplace_back(edit.pointer, edit.value);
    set(edits, values.gesture);
}

/// Puts the hand's pull into the scene, or takes it out.
void Studio::set_pull(const std::string& id, const Hand* hand) {
    Json pulls = scene_to_json(session().scene())["pulls"];
    const auto found =
        std::find_if(pulls.begin(), pulls.end(), [&](const Json& pull) { return pull.at("name") == id; });
    if (found == pulls.end() && hand)
        pulls.push_back(hand->pull());
    else if (found != pulls.end() && hand)
        *found = hand->pull();
    else if (found != pulls.end())
        pulls.erase(found);
    else
        return;
    set({{"/pulls", pulls}}, id);
}

void Studio::perform(ClientId client, const Grab& grab) {
    StagedRun& run = session().run();
    auto found = hands_.find(grab.id);
    if (found == hands_.end()) {
        const auto asked = shows_.find(client);
        const bool detail = asked != shows_.end() && asked->second.detail;
        const Positions& fine = run.stepper().problem().carried(run.stepper().unknowns());
        const int level = detail ? run.discretization().finest() : run.level();
        const Positions shown = detail ? fine : run.stepper().positions();
        if (grab.vertex >= shown.cols())
            throw InputError("grab", fmt::format("there is no vertex {}", grab.vertex),
                             "take hold of one that is shown");
        Hand hand = take_hold(run.discretization(), level, grab.vertex, fine, shown.col(grab.vertex));
        hand.id = grab.id;
        found = hands_.emplace(grab.id, std::move(hand)).first;
    }
    found->second.to = grab.to;
    set_pull(grab.id, &found->second);
    if (state_ == State::idle)
        set_state(State::playing);
}

void Studio::perform(ClientId, const Release& release) {
    hands_.erase(release.id);
    set_pull(release.id, nullptr);
    tell_parts();
}

void Studio::perform(ClientId, const Pin& pin) {
    hands_.erase(pin.id);
    tell_parts();
}

void Studio::perform(ClientId, const Undo&) {
    if (session().undo())
        jump();
}

void Studio::perform(ClientId, const Redo&) {
    if (session().redo())
        jump();
}

void Studio::perform(ClientId, const Refine& refine) {
    StagedRun& run = session().run();
    if (run.level() == run.last_level())
        throw InputError("refine", "this is the finest level", "go back to the preview, or let it settle");
    refine_to_ = refine.to_finest ? run.last_level() : run.level() + 1;
    message_.clear();
    set_state(State::refining);
    refine_once();
}

void Studio::perform(ClientId, const Stop&) {
    if (is_at_work())
        set_state(State::idle);
}

void Studio::perform(ClientId, const Preview&) {
    if (session().back_to_preview())
        jump();
}

void Studio::perform(ClientId, const Restart&) {
    set_state(State::building);
    session().restart();
    begin_anew();
    set_state(State::idle);
}

void Studio::perform(ClientId client, const Show& show) {
    shows_[client] = show;
    if (session_ && !scrubbing_.contains(client))
        board_.show(client, projector_.picture(session_->run(), show));
}

void Studio::perform(ClientId client, const ShowFrame& frame) {
    if (!frame.index) {
        scrubbing_.erase(client);
        if (session_)
            board_.show(client, projector_.picture(session_->run(), shows_[client]));
        return;
    }
    const auto index = static_cast<std::size_t>(*frame.index);
    if (!board_.show_frame(client, index))
        throw InputError("frame", fmt::format("there is no frame {}", index),
                         fmt::format("there are {}", board_.frame_count()));
    scrubbing_[client] = index;
}

void Studio::perform(ClientId, const Save& save) {
    EditLog log = session().edits();
    StagedRun& run = session().run();
    log.push_back(std::make_shared<const Edit>(Edit{Edit::Kind::end, run.level(), session().steps(), {}, {}}));
    const Json saved = {{"type", "saved"}, {"files", folder_.save(save.name, session().first_scene(), log)}};
    file_name_ = save.name;
    board_.mention(saved.dump());
    tell_scene();
}

void Studio::perform(ClientId, const Export& what) {
    StagedRun& run = session().run();
    std::vector<Board::SavedFrame> states;
    if (what.animation)
        states = board_.frames_of(run.level());
    if (states.size() < 2) {
        const auto now = std::make_shared<const Positions>(run.stepper().positions());
        states.assign(1, {{}, {}, run.level(), run.stepper().progress().t, now});
    }
    const std::string file = export_states(folder_.files(), file_name_, what.format, run.discretization(), states);
    board_.mention(Json{{"type", "saved"}, {"files", {file}}}.dump());
}

} // namespace plisse::studio
