#include <plisse/steer/replay.h>

#include <algorithm>

#include <fmt/format.h>

#include <plisse/base/error.h>
#include <plisse/steer/edited_scene.h>

namespace plisse {

namespace {

using StepEnd = Session::StepEnd;

/// The edits that a run which has come to this state has made. One between the step it came to and the next is made
/// again: that changes nothing.
EditLog made_before(const EditLog& log, const Checkpoint& state) {
    int steps = 0;
    for (const LevelReport& level : state.report.levels)
        if (level.level == state.level)
            steps = level.steps;
    EditLog made;
    for (const auto& edit : log)
        if (edit->level < state.level || (edit->level == state.level && edit->step < steps))
            made.push_back(edit);
    return made;
}

/// Makes the edits of a log, each at its step.
class Follower {
public:
    enum class Move { edited, stepped, rested, ended, cancelled, not_refined };

    Follower(Session& session, const EditLog& log) : session_(session), log_(log), next_(session.edits().size()) {}

    bool is_through() const { return next_ == log_.size(); }
    const std::string& reason() const { return reason_; } ///< why it was not refined

    /// Makes the next edit where it is due, else takes a step.
    Move move() {
        if (is_due())
            return make_edit(*log_[next_++]);
        const StepEnd step = rested_ ? last_ : session_.step();
        if (step == StepEnd::cancelled)
            return Move::cancelled;
        last_ = step;
        rested_ = step != StepEnd::stepped;
        return rested_ ? Move::rested : Move::stepped;
    }

    /// The next step is the first of a level.
    void begin_level() { rested_ = false; }

    /// How the last step ended.
    StepEnd last_step() const { return last_; }

private:
    bool is_due() {
        if (is_through())
            return false;
        const Edit& edit = *log_[next_];
        return rested_ || (edit.level == session_.run().level() && edit.step <= session_.steps());
    }

    Move make_edit(const Edit& edit) {
        if (edit.kind == Edit::Kind::end)
            return Move::ended;
        rested_ = false;
        if (edit.kind == Edit::Kind::refine)
            return session_.refine(reason_) ? Move::edited : Move::not_refined;
        if (!can_go_on(session_.scene(), edited_scene(session_.scene(), edit.pointer, edit.value)))
            throw InputError(edit.pointer, "a run cannot take over this edit while it goes on",
                             "give the scene this value from the beginning");
        session_.set({{edit.pointer, edit.value}});
        return Move::edited;
    }

    Session& session_;
    const EditLog& log_;
    std::size_t next_;
    StepEnd last_ = StepEnd::stepped;
    bool rested_ = false; ///< the level has come to its end
    std::string reason_;
};

/// Ends a run that has followed its log, or goes on with it as run() does.
class Replay {
public:
    Replay(Session& session, const EditLog& log, Context& context)
        : session_(session), context_(context), follower_(session, log) {}

    void run() {
        using Move = Follower::Move;
        for (;;)
            switch (follower_.move()) {
            case Move::edited:
            case Move::stepped:
                break;
            case Move::rested:
                if (follower_.is_through() && !go_on())
                    return;
                break;
            case Move::ended:
                return end();
            case Move::cancelled:
                return fail(RunStatus::interrupted, "interrupted");
            case Move::not_refined:
                return fail_to_refine(follower_.reason());
            }
    }

private:
    /// From the end of a level; false at the end of the run.
    bool go_on() {
        StagedRun& run = session_.run();
        if (follower_.last_step() == StepEnd::not_settled)
            fail(RunStatus::not_converged, fmt::format("level {} did not reach equilibrium", run.level()));
        if (run.level() == run.last_level()) {
            run.finish();
            return false;
        }
        std::string reason;
        if (session_.refine(reason)) {
            follower_.begin_level();
            return true;
        }
        fail_to_refine(reason);
        return false;
    }

    void end() {
        StagedRun& run = session_.run();
        if (!session_.is_at_rest())
            fail(RunStatus::not_converged, fmt::format("the edit log ends at step {} of level {}, before equilibrium",
                                                       session_.steps(), run.level()));
        run.finish();
    }

    void fail_to_refine(const std::string& reason) {
        if (context_.cancelled())
            fail(RunStatus::interrupted, "interrupted");
        else
            fail(RunStatus::not_converged, reason);
    }

    void fail(RunStatus status, const std::string& message) { session_.run().fail(status, message); }

    Session& session_;
    Context& context_;
    Follower follower_;
};

} // namespace

bool follow(Session& session, const EditLog& log) {
    using Move = Follower::Move;
    Follower follower(session, log);
    while (!follower.is_through()) {
        const Move move = follower.move();
        if (move == Move::cancelled || move == Move::not_refined)
            return false;
    }
    return true;
}

RunResult replay(const Scene& scene, const EditLog& log, const RunOptions& options, Recorder& recorder,
                 Context& context) {
    const EditLog made = options.resume ? made_before(log, *options.resume) : EditLog();
    Session session(scene, made, options, recorder, context);
    Replay(session, log, context).run();
    session.run().log().publish();
    return session.run().result();
}

} // namespace plisse
