#include <plisse/steer/replay.h>

#include <algorithm>

#include <fmt/format.h>

#include <plisse/base/error.h>

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

class Replay {
public:
    Replay(Session& session, const EditLog& log, Context& context)
        : session_(session), log_(log), context_(context), next_(session.edits().size()) {}

    void run() {
        while (!over_) {
            if (is_due())
                make_edit(*log_[next_++]);
            else
                go_on();
        }
    }

private:
    bool is_due() {
        if (next_ == log_.size())
            return false;
        const Edit& edit = *log_[next_];
        return rested_ || (edit.level == session_.run().level() && edit.step <= session_.steps());
    }

    void make_edit(const Edit& edit) {
        switch (edit.kind) {
        case Edit::Kind::set:
            if (!session_.set({{edit.pointer, edit.value}}))
                throw InputError(edit.pointer, "a run cannot take over this edit while it goes on",
                                 "give the scene this value from the beginning");
            rested_ = false;
            break;
        case Edit::Kind::refine:
            refine();
            break;
        case Edit::Kind::end:
            end();
            break;
        }
    }

    void go_on() {
        StagedRun& run = session_.run();
        const StepEnd step = rested_ ? StepEnd::at_rest : session_.step();
        if (step == StepEnd::stepped)
            return;
        if (step == StepEnd::cancelled)
            return interrupt();
        rested_ = true;
        if (next_ < log_.size())
            return;
        expect_equilibrium(step);
        if (run.level() == run.last_level())
            end();
        else
            refine();
    }

    void expect_equilibrium(StepEnd step) {
        StagedRun& run = session_.run();
        if (step == StepEnd::not_settled)
            run.fail(RunStatus::not_converged, fmt::format("level {} did not reach equilibrium", run.level()));
    }

    void refine() {
        rested_ = false;
        std::string reason;
        if (session_.refine(reason))
            return;
        if (context_.cancelled())
            return interrupt();
        session_.run().fail(RunStatus::not_converged, reason);
        over_ = true;
    }

    void end() {
        StagedRun& run = session_.run();
        if (!session_.is_at_rest())
            run.fail(RunStatus::not_converged,
                     fmt::format("the edit log ends at step {} of level {}, before equilibrium", session_.steps(),
                                 run.level()));
        run.finish();
        over_ = true;
    }

    void interrupt() {
        session_.run().fail(RunStatus::interrupted, "interrupted");
        over_ = true;
    }

    Session& session_;
    const EditLog& log_;
    Context& context_;
    std::size_t next_;
    bool rested_ = false; ///< the level has come to its end
    bool over_ = false;
};

} // namespace

RunResult replay(const Scene& scene, const EditLog& log, const RunOptions& options, Recorder& recorder,
                 Context& context) {
    const EditLog made = options.resume ? made_before(log, *options.resume) : EditLog();
    Session session(scene, made, options, recorder, context);
    Replay(session, log, context).run();
    session.run().log().publish();
    return session.run().result();
}

} // namespace plisse
