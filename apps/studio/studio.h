#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <plisse/scene/hierarchy_cache.h>
#include <plisse/steer/session.h>

#include "autosave.h"
#include "board.h"
#include "commands.h"
#include "export_states.h"
#include "gallery.h"
#include "hand.h"
#include "projector.h"
#include "session_folder.h"
#include "step_rate.h"
#include "task_queue.h"

namespace plisse::studio {

/// The one session that all pages steer and see. Pages' commands wait in a queue; a thread of its own takes them
/// between the steps of the run, which commands that make its step worthless cut short.
class Studio final : public Application, private Recorder, private Context {
public:
    explicit Studio(std::filesystem::path folder);
    ~Studio() override;

    /// Begins to work; the server must outlive what is done until stop().
    void start(Server& server);
    void stop();
    /// Opens a scene file, as the command line names it.
    void open(const std::filesystem::path& scene);

    void on_join(ClientId client) override;
    void on_leave(ClientId client) override;
    void on_message(ClientId client, std::string_view text) override;
    void on_request(HttpRequest request, Reply reply) override;

private:
    using Clock = std::chrono::steady_clock;
    enum class State { empty, building, idle, playing, refining, at_rest, failed };
    struct NewFrame {
        int level;
        double t;
        std::string phase;
        std::shared_ptr<const Positions> positions;
    };
    struct Task {
        ClientId client = 0;
        std::optional<Command> command;
        std::function<void()> work; ///< where there is no command
        Clock::time_point arrival{};
    };

    void work();
    void do_tasks(std::vector<Task> tasks);
    void do_task(const Task& task);
    bool is_at_work() const { return state_ == State::playing || state_ == State::refining; }
    void advance();
    void take_step();
    void end_of_level(Session::StepEnd end);
    void refine_once();
    void keep_session();

    void perform(ClientId client, const OpenScene& open);
    void perform(ClientId client, const Play&);
    void perform(ClientId client, const Pause&);
    void perform(ClientId client, const Step&);
    void perform(ClientId client, const SetValues& values);
    void perform(ClientId client, const Grab& grab);
    void perform(ClientId client, const Release& release);
    void perform(ClientId client, const Pin& pin);
    void perform(ClientId client, const Undo&);
    void perform(ClientId client, const Redo&);
    void perform(ClientId client, const Refine& refine);
    void perform(ClientId client, const Stop&);
    void perform(ClientId client, const Preview&);
    void perform(ClientId client, const Restart&);
    void perform(ClientId client, const Show& show);
    void perform(ClientId client, const ShowFrame& frame);
    void perform(ClientId client, const Save& save);
    void perform(ClientId client, const Export& what);

    Session& session();
    void begin_saved(const std::string& name);
    void begin(const Scene& scene, const std::string& name, State next);
    void set(const std::vector<std::pair<std::string, nlohmann::ordered_json>>& values, const std::string& gesture);
    void set_pull(const std::string& id, const Hand* hand);
    void begin_anew();
    void jump();
    void show_session();
    void keep_settling_step();
    void keep_frames();
    HttpAnswer open_mesh(const std::map<std::string, std::string>& query, const std::string& bytes);
    HttpAnswer open_scene_text(const std::string& text);
    HttpAnswer answer(const HttpRequest& request) const;

    void on_frame(const Frame& frame) override;
    void on_progress(const Progress& progress) override;
    void on_message(const std::string& message) override;

    void set_state(State state);
    void tell_scene();
    void tell_status(bool now = true);
    void tell_parts();
    void show_all();
    void tell_sample(double seconds, int iterations);

    Board board_;
    Projector projector_;
    SessionFolder folder_;
    Autosave autosave_{folder_};
    std::optional<HierarchyCache> cache_;

    TaskQueue<Task> tasks_{*this};
    std::atomic<bool> steps_are_long_{false}; ///< so that changes cut them short
    std::thread thread_;

    // What follows belongs to the thread.
    std::unique_ptr<Session> session_;
    State state_ = State::empty;
    int refine_to_ = 0, refusals_ = 0;
    std::string file_name_ = "scene", message_;
    std::vector<NewFrame> frames_; ///< that the run has saved since the last were kept
    std::map<ClientId, Show> shows_;
    std::map<ClientId, std::size_t> scrubbing_;     ///< the saved frame a page looks at
    std::map<std::string, Hand> hands_;             ///< by the id of their grab
    Clock::time_point arrival_{};                   ///< of the task that is done
    std::optional<Clock::time_point> edit_arrival_; ///< of a change that no step has shown yet
    double edit_to_step_ms_ = 0;
    StepRate step_rate_;
    Clock::time_point last_status_{}, last_progress_{};
};

} // namespace plisse::studio
