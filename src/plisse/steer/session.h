#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <plisse/drive/staged_run.h>
#include <plisse/scene/scene.h>
#include <plisse/steer/edit_log.h>

namespace plisse {

/// A run that is steered while it goes on: parameters change between its steps, it is refined when asked to, and every
/// change can be undone. What it did is an EditLog, by which replay() does the same in every bit.
class Session {
public:
    enum class StepEnd {
        stepped,
        at_rest,     ///< equilibrium, or the end of the timeline where nothing is to settle; no step was needed
        not_settled, ///< as many settling steps as there may be were not enough, or a script is blocked
        cancelled    ///< the state is that of before the step
    };

    /// Builds the scene's model and begins its run, or takes up one that has made these edits, at options.resume. What
    /// the options point to, recorder and context must outlive the session. Throws InputError for a scene that cannot
    /// be run, and for a method that is not progressive.
    Session(Scene scene, EditLog made, const RunOptions& options, Recorder& recorder, Context& context);
    ~Session();

    /// The scene as it was when the run began (of the same run always the same object), and with what has been edited
    /// since.
    const std::shared_ptr<const Scene>& first_scene() const { return first_; }
    const Scene& scene() const { return scene_; }
    const EditLog& edits() const { return edits_; }
    /// The same with an end to it, here and now: who follows it comes to this state and stays there.
    EditLog ended_edits();
    StagedRun& run() { return *run_; }
    /// Steps taken on the level, as edits count them.
    int steps();
    bool timeline_is_over();
    /// Whether the level has ended, in equilibrium where it was to settle.
    bool is_at_rest() const { return concluded_; }

    /// The next step of the level. What was undone before it cannot be redone.
    StepEnd step();
    /// Changes the scene. The run goes on where it can (can_go_on), else it begins anew; true says that it goes on.
    /// Throws InputError, and nothing has changed. gesture: edits of the same one are undone together; "" stands alone.
    bool set(const std::vector<std::pair<std::string, nlohmann::ordered_json>>& values,
             const std::string& gesture = "");
    /// Takes the state to the next level. False when it is cancelled or not complete, with the reason; nothing has
    /// changed then.
    bool refine(std::string& reason);
    /// Back to the state of level 0 from which refining began. False when the run is there.
    bool back_to_preview();
    /// Begins anew with the scene as it is now.
    void restart();

    /// How much of what has been sent out belongs to the state: whoever steers sets it, and undoing brings it back.
    struct Marks {
        std::size_t frames = 0, samples = 0;
    };
    Marks marks;

    bool can_undo() const { return !undo_.empty(); }
    bool can_redo() const { return !redo_.empty(); }
    /// Brings back the state, the scene and the log of before the last change (of after it). False when there is none.
    bool undo();
    bool redo();

private:
    struct Snapshot;
    Snapshot snapshot();
    void restore(const Snapshot& snapshot);
    void remember(const std::string& gesture);
    std::unique_ptr<StagedRun> begin(const Scene& scene, const Checkpoint* state);
    void take(std::unique_ptr<StagedRun> fresh, const Scene& scene);
    void log(Edit edit);

    RunOptions options_; ///< but for the state to resume
    Recorder& recorder_;
    Context& context_;
    std::shared_ptr<const Scene> first_;
    Scene scene_;
    EditLog edits_;
    std::unique_ptr<StagedRun> run_;
    bool concluded_ = false; ///< whether the level has been ended since its last step
    std::vector<Snapshot> undo_, redo_;
    std::string gesture_;
};

} // namespace plisse
