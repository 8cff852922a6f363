#include "studio.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/scene/read_scene.h>
#include <plisse/steer/replay.h>

#include "scene_files.h"

namespace plisse::studio {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::milliseconds progress_interval{100};
constexpr int most_refusals = 3; ///< of one refinement; after each a step leads to another state

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
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
        try {
            if (is_at_work() && !tasks_.is_closed())
                advance();
        } catch (const std::exception& error) {
            message_ = error.what();
            set_state(State::failed);
        }
        keep_session();
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
    const bool has_farther_to_go = state_ == State::refining && session_->run().level() < refine_to_;
    if (has_farther_to_go && session_->is_at_rest())
        return refine_once();
    const int steps_before = session_->steps();
    take_step();
    // A state that could not be refined has been left now.
    if (has_farther_to_go && refusals_ > 0 && state_ == State::refining && session_->steps() > steps_before)
        refine_once();
}

void Studio::take_step() {
    const auto begin = Clock::now();
    StagedRun& run = session_->run();
    const int iterations_before = run.log().level_report(run.level()).newton_iterations;
    const Session::StepEnd end = session_->step();
    if (end == Session::StepEnd::cancelled)
        return;
    const auto now = Clock::now();
    step_rate_.add(now);
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
        refusals_ = 0;
        message_.clear();
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
    if (session_->is_at_rest() || ++refusals_ > most_refusals)
        set_state(State::idle);
}

/// A disk that is full is no reason to stop.
void Studio::keep_session() {
    if (!session_)
        return;
    try {
        autosave_.keep(*session_, !is_at_work() || tasks_.is_closed());
    } catch (const std::exception& error) {
        message_ = error.what();
        tell_status();
    }
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
    Json json = {{"type", "progress"}, {"fraction", progress.fraction}};
    if (progress.phase == "refine")
        json.update({{"text", fmt::format("level {}: undoing collapses, batch {} of {}", progress.level, progress.step,
                                          progress.step_count)},
                     {"batch", progress.step},
                     {"batches", progress.step_count}});
    else
        json["text"] =
            fmt::format("level {}: step {}, iteration {}", progress.level, progress.step, progress.iteration);
    board_.mention(json.dump());
}

void Studio::on_message(const std::string& message) {
    message_ = message;
}

// ---- sessions

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
    step_rate_.clear();
    begin_anew();
    if (scene.edits) {
        follow(*session_, read_edit_log(scene.folder / *scene.edits));
        keep_frames();
        show_session();
    }
    autosave_.begin(*session_);
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
    message_.clear();
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

} // namespace plisse::studio
