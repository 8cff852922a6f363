#include <plisse/steer/session.h>

#include <fmt/format.h>

#include <plisse/scene/build_model.h>
#include <plisse/scene/model_parameters.h>
#include <plisse/steer/edited_scene.h>

namespace plisse {

namespace {

constexpr std::size_t most_snapshots = 200;

} // namespace

/// Everything that undoing brings back.
struct Session::Snapshot {
    std::shared_ptr<const Scene> first;
    Scene scene;
    EditLog edits;
    Checkpoint state;
    bool concluded;
    Marks marks;
};

Session::Session(Scene scene, EditLog made, const RunOptions& options, Recorder& recorder, Context& context)
    : options_(options), recorder_(recorder), context_(context), first_(std::make_shared<const Scene>(scene)),
      scene_(std::move(scene)), edits_(std::move(made)) {
    for (const auto& edit : edits_)
        if (edit->kind == Edit::Kind::set)
            scene_ = edited_scene(scene_, edit->pointer, edit->value);
    run_ = begin(scene_, options.resume);
    concluded_ = options.resume && options.resume->settled;
}

Session::~Session() = default;

std::unique_ptr<StagedRun> Session::begin(const Scene& scene, const Checkpoint* state) {
    if (scene.solve.method != Method::progressive)
        throw scene.error_at("/solve/method", "a run of this method cannot be steered", "give \"progressive\"");
    RunOptions options = options_;
    options.resume = state;
    auto run = std::make_unique<StagedRun>(build_model(scene, context_), options, recorder_, context_);
    if (!state)
        run->log().frame(run->level(), 0, "preview", run->stepper().positions());
    return run;
}

/// Goes over to a run that has just begun.
void Session::take(std::unique_ptr<StagedRun> fresh, const Scene& scene) {
    undo_.push_back(snapshot());
    redo_.clear();
    gesture_.clear();
    run_ = std::move(fresh);
    scene_ = scene;
    first_ = std::make_shared<const Scene>(scene_);
    edits_.clear();
    concluded_ = false;
    marks = {};
}

int Session::steps() {
    return run_->log().level_report(run_->level()).steps;
}

EditLog Session::ended_edits() {
    EditLog log = edits_;
    log.push_back(std::make_shared<const Edit>(Edit{Edit::Kind::end, run_->level(), steps(), {}, {}}));
    return log;
}

bool Session::timeline_is_over() {
    return run_->level() > run_->first_level() || run_->stepper().timeline_is_over(run_->duration());
}

Session::StepEnd Session::step() {
    if (concluded_)
        return StepEnd::at_rest;
    redo_.clear();
    const Checkpoint before = run_->state();
    const auto give_back = [&](StepEnd end) {
        run_->restore(before);
        return end;
    };
    if (!run_->bring_to_thickness())
        return give_back(context_.cancelled() ? StepEnd::cancelled : StepEnd::not_settled);
    LevelStepper& stepper = run_->stepper();
    const SolveSettings& solve = scene_.solve;
    if (!timeline_is_over())
        return stepper.step_timeline(run_->duration()) == LevelStepper::Outcome::cancelled
                   ? give_back(StepEnd::cancelled)
                   : StepEnd::stepped;
    if (solve.settle && stepper.progress().settle_step >= solve.max_settle_steps)
        return StepEnd::not_settled;
    const bool only_once = !solve.settle && run_->level() > run_->first_level();
    LevelStepper::Outcome outcome = LevelStepper::Outcome::done;
    if (solve.settle)
        outcome = stepper.step_settling(run_->time());
    else if (only_once)
        outcome = stepper.step_once(run_->time());
    if (outcome == LevelStepper::Outcome::cancelled)
        return give_back(StepEnd::cancelled);
    if (outcome == LevelStepper::Outcome::stalled)
        return StepEnd::not_settled;
    if (solve.settle && outcome == LevelStepper::Outcome::cut_short)
        return StepEnd::stepped;
    run_->conclude_level();
    concluded_ = true;
    return StepEnd::at_rest;
}

bool Session::set(const std::vector<std::pair<std::string, nlohmann::ordered_json>>& values,
                  const std::string& gesture) {
    Scene edited = scene_;
    for (const auto& [pointer, value] : values)
        edited = edited_scene(edited, pointer, value);
    if (!can_go_on(scene_, edited)) {
        take(begin(edited, nullptr), edited);
        return false;
    }
    Model model = run_->discretization().model();
    set_parameters(edited, model);
    remember(gesture);
    scene_ = std::move(edited);
    run_->set_model(std::move(model));
    concluded_ = false;
    for (const auto& [pointer, value] : values)
        log({Edit::Kind::set, 0, 0, pointer, value});
    return true;
}

/// Of two values given to one place between the same steps only the last counts.
void Session::log(Edit edit) {
    edit.level = run_->level();
    edit.step = steps();
    if (!edits_.empty()) {
        const Edit& last = *edits_.back();
        if (last.kind == Edit::Kind::set && edit.kind == Edit::Kind::set && last.level == edit.level &&
            last.step == edit.step && last.pointer == edit.pointer)
            edits_.pop_back();
    }
    edits_.push_back(std::make_shared<const Edit>(std::move(edit)));
}

bool Session::refine(std::string& reason) {
    if (run_->level() == run_->last_level()) {
        reason = "this is the finest level";
        return false;
    }
    Snapshot before = snapshot();
    const Edit edit{Edit::Kind::refine, run_->level(), steps(), {}, {}};
    if (!run_->refine()) {
        reason = context_.cancelled() ? "cancelled" : run_->report().message;
        run_->restore(before.state);
        return false;
    }
    undo_.push_back(std::move(before));
    redo_.clear();
    gesture_.clear();
    edits_.push_back(std::make_shared<const Edit>(edit));
    concluded_ = false;
    return true;
}

bool Session::back_to_preview() {
    if (run_->level() == run_->first_level())
        return false;
    // Where refining began is the newest state of level 0 that a change has left.
    for (auto found = undo_.rbegin(); found != undo_.rend(); ++found)
        if (found->first == first_ && found->state.level == run_->first_level()) {
            const Snapshot coarse = *found;
            remember("");
            restore(coarse);
            return true;
        }
    return false;
}

void Session::restart() {
    take(begin(scene_, nullptr), Scene(scene_));
}

void Session::remember(const std::string& gesture) {
    const bool goes_on = !gesture.empty() && gesture == gesture_ && !undo_.empty();
    redo_.clear();
    gesture_ = gesture;
    if (goes_on)
        return;
    undo_.push_back(snapshot());
    if (undo_.size() > most_snapshots)
        undo_.erase(undo_.begin());
}

Session::Snapshot Session::snapshot() {
    return {first_, scene_, edits_, run_->state(), concluded_, marks};
}

void Session::restore(const Snapshot& snapshot) {
    if (snapshot.first != first_) {
        run_ = begin(snapshot.scene, &snapshot.state);
    } else {
        Model model = run_->discretization().model();
        set_parameters(snapshot.scene, model);
        run_->restore(snapshot.state, std::move(model));
    }
    first_ = snapshot.first;
    scene_ = snapshot.scene;
    edits_ = snapshot.edits;
    concluded_ = snapshot.concluded;
    marks = snapshot.marks;
    gesture_.clear();
}

bool Session::undo() {
    if (undo_.empty())
        return false;
    Snapshot now = snapshot();
    restore(undo_.back());
    undo_.pop_back();
    redo_.push_back(std::move(now));
    return true;
}

bool Session::redo() {
    if (redo_.empty())
        return false;
    Snapshot now = snapshot();
    restore(redo_.back());
    redo_.pop_back();
    undo_.push_back(std::move(now));
    return true;
}

} // namespace plisse
