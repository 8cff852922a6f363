// What pages' commands do.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/scene/json_writer.h>
#include <plisse/scene/read_scene.h>
#include <plisse/scene/write_scene.h>
#include <plisse/steer/edited_scene.h>

#include "scene_files.h"
#include "studio.h"

namespace plisse::studio {

using Json = nlohmann::ordered_json;

void Studio::perform(ClientId, const OpenScene& open) {
    if (!open.file.empty())
        return begin_saved(open.file);
    const GalleryScene* scene = find_gallery_scene(open.gallery);
    if (!scene)
        throw InputError("gallery", fmt::format("there is no scene \"{}\"", open.gallery), "take one of the list");
    begin(parse_scene(scene->id + ".json", scene->text, folder_.files()), scene->id, State::idle);
}

/// Opens a scene of the session's folder.
void Studio::begin_saved(const std::string& name) {
    const std::filesystem::path path = folder_.file(name);
    if (path.empty())
        throw InputError(name, "nothing of this name has been saved", "take one of the list");
    const Scene scene = read_scene(path);
    expect_no_other_files(scene, {}, folder_.files());
    begin(scene, std::filesystem::path(name).stem().string(), State::idle);
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
    message_.clear();
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
    refusals_ = 0;
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
    if (save.name == Autosave::name)
        throw InputError("save", fmt::format("the name {} is kept for what is saved by itself", save.name),
                         "take another");
    const EditLog log = session().ended_edits();
    const Json saved = {{"type", "saved"}, {"files", folder_.save(save.name, *session_->first_scene(), log)}};
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
