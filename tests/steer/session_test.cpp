#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/base/parallel.h>
#include <plisse/steer/replay.h>

#include "drive/witness.h"
#include "small_scene.h"

using namespace plisse;

namespace {

using Json = nlohmann::ordered_json;
using StepEnd = Session::StepEnd;

/// A session with what it needs.
struct Steered {
    Context context;
    Witness witness;
    Session session;

    explicit Steered(const Scene& scene = small_scene()) : session(scene, {}, {}, witness, context) {}
    void step(int times) {
        for (int i = 0; i < times; ++i)
            session.step();
    }
    StepEnd run_to_rest() {
        StepEnd end = StepEnd::stepped;
        while (end == StepEnd::stepped)
            end = session.step();
        return end;
    }
    bool set(const char* pointer, const Json& value, const char* gesture = "") {
        return session.set({{pointer, value}}, gesture);
    }
    Positions positions() { return session.run().stepper().positions(); }
};

const Json up = {0, 4, 0};

/// Steers through changes of every kind and a refinement.
void steer(Steered& steered) {
    steered.step(3);
    EXPECT_TRUE(steered.set("/gravity", {0, -3, 0}, "slider"));
    EXPECT_TRUE(steered.set("/gravity", {0, -5, 0}, "slider"));
    steered.step(2);
    EXPECT_TRUE(steered.session.set({{"/bodies/0/material", "silk"}, {"/solve/time_step", 0.04}}));
    EXPECT_TRUE(steered.set("/handles/0/motion", Json::parse(R"([{"t": 0, "translate": [0.02, 0.05, 0]}])")));
    steered.step(3);
    EXPECT_TRUE(steered.set("/pulls", Json::parse(R"([{"body": "cloth", "stiffness": 2,
        "points": [{"vertex": 5, "to": [0.2, 0.3, 0.1]}, {"vertex": 9, "to": [0.2, 0.3, 0]}]}])")));
    steered.step(4);
    std::string reason;
    ASSERT_TRUE(steered.session.refine(reason)) << reason;
    steered.step(2);
    EXPECT_TRUE(steered.set("/contact/friction", 0.1));
    steered.step(2);
}

TEST(Session, StepsAsARunDoes) {
    const Scene scene = small_scene();
    Steered steered(scene);
    ASSERT_EQ(steered.run_to_rest(), StepEnd::at_rest);
    std::string reason;
    ASSERT_TRUE(steered.session.refine(reason)) << reason;
    ASSERT_EQ(steered.run_to_rest(), StepEnd::at_rest);
    EXPECT_EQ(steered.session.step(), StepEnd::at_rest);

    Context context;
    Witness witness;
    const RunResult whole = replay(scene, {}, {}, witness, context);
    EXPECT_EQ(whole.report.status, RunStatus::converged) << whole.report.message;
    EXPECT_EQ(whole.positions, steered.positions());
    EXPECT_EQ(witness.intersections, 0);
}

TEST(Session, IsReplayedToTheSameBitsOnAnyNumberOfThreads) {
    Steered steered;
    steer(steered);
    EXPECT_EQ(steered.witness.intersections, 0);
    const EditLog log = steered.session.ended_edits();
    EXPECT_EQ(log.size(), 8u); // the gesture's two sets at one step are one
    for (int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        Context context;
        Witness witness;
        const RunResult result = replay(*steered.session.first_scene(), log, {}, witness, context);
        EXPECT_EQ(result.level, 1);
        EXPECT_EQ(result.positions, steered.positions());
    }
}

TEST(Session, GivesBackWhatWasBeforeEveryChange) {
    Steered steered;
    steered.step(4);
    const Positions before = steered.positions();
    steered.set("/gravity", up, "slider");
    steered.step(1);
    steered.set("/gravity", {0, 5, 0}, "slider");
    steered.step(2);
    const Positions after = steered.positions();
    ASSERT_TRUE(steered.session.undo());
    EXPECT_FALSE(steered.session.can_undo()); // one gesture, one change
    EXPECT_EQ(steered.positions(), before);
    EXPECT_EQ(steered.session.scene().gravity.at(0), Vec3(0, -9.81, 0));
    EXPECT_TRUE(steered.session.edits().empty());
    ASSERT_TRUE(steered.session.redo());
    EXPECT_EQ(steered.positions(), after);
    EXPECT_EQ(steered.session.scene().gravity.at(0), Vec3(0, 5, 0));
    EXPECT_EQ(steered.session.edits().size(), 2u);
    Steered followed;
    EXPECT_TRUE(follow(followed.session, steered.session.edits()));
    EXPECT_EQ(followed.session.edits().size(), 2u);
    followed.step(2);
    EXPECT_EQ(followed.positions(), after);

    // What was undone is gone once something else has been done.
    followed.session.undo();
    EXPECT_TRUE(followed.session.can_redo());
    followed.set("/contact/friction", 0.2);
    EXPECT_FALSE(followed.session.redo());

    // From what was brought back the run goes on as it went.
    steered.session.undo();
    steered.step(3);
    Steered untouched;
    untouched.step(7);
    EXPECT_EQ(steered.positions(), untouched.positions());
    EXPECT_FALSE(Steered().session.undo());
}

TEST(Session, GoesBackFromARefinementAndFromANewBeginning) {
    Steered steered;
    steered.step(5);
    const Positions coarse = steered.positions();
    std::string reason;
    ASSERT_TRUE(steered.session.refine(reason)) << reason;
    steered.step(1);
    EXPECT_FALSE(steered.session.refine(reason));
    EXPECT_EQ(reason, "this is the finest level");
    const Positions fine = steered.positions();
    ASSERT_TRUE(steered.session.back_to_preview());
    EXPECT_EQ(steered.positions(), coarse);
    EXPECT_FALSE(steered.session.back_to_preview());
    ASSERT_TRUE(steered.session.undo());
    EXPECT_EQ(steered.positions(), fine);

    EXPECT_FALSE(steered.set("/bodies/0/mesh/edge_length", 0.05)); // begins anew
    EXPECT_EQ(steered.session.steps(), 0);
    EXPECT_TRUE(steered.session.edits().empty());
    steered.step(2);
    ASSERT_TRUE(steered.session.undo());
    EXPECT_EQ(steered.positions(), fine);
    EXPECT_EQ(steered.session.edits().size(), 1u);
}

TEST(Session, StaysAsItWasWhereAChangeIsRefused) {
    Steered steered;
    steered.step(2);
    const Positions before = steered.positions();
    EXPECT_THROW(steered.set("/contact/friction", -1), InputError);
    EXPECT_THROW(steered.set("/pulls", Json::parse(R"([{"body": "cloth", "stiffness": 1,
        "points": [{"vertex": 100000, "to": [0, 0, 0]}]}])")),
                 InputError);
    EXPECT_THROW(steered.set("/bodies/0/transform/translate", {0, 0.05, 0}), InputError); // into the ball
    EXPECT_EQ(steered.positions(), before);
    EXPECT_FALSE(steered.session.can_undo());
    EXPECT_TRUE(steered.session.edits().empty());
    steered.step(1);
    Steered untouched;
    untouched.step(3);
    EXPECT_EQ(steered.positions(), untouched.positions());
}

TEST(Session, ACancelledStepLeavesNoTrace) {
    Steered steered;
    steered.step(2);
    const Positions before = steered.positions();
    steered.context.cancel();
    EXPECT_EQ(steered.session.step(), StepEnd::cancelled);
    std::string reason;
    EXPECT_FALSE(steered.session.refine(reason));
    EXPECT_EQ(steered.positions(), before);
    EXPECT_EQ(steered.session.steps(), 2);
    steered.context.resume();
    steered.step(1);
    Steered untouched;
    untouched.step(3);
    EXPECT_EQ(steered.positions(), untouched.positions());
}

/// Stops a run after so many checkpoints, and keeps the last.
struct Interrupter : Recorder {
    Context& context;
    int left;
    Checkpoint last;
    Interrupter(Context& stopped, int checkpoints) : context(stopped), left(checkpoints) {}
    void on_checkpoint(const Checkpoint& checkpoint) override {
        last = checkpoint;
        if (--left == 0)
            context.cancel();
    }
};

TEST(Replay, IsResumedToTheSameBits) {
    Steered steered;
    steer(steered);
    const Scene scene = small_scene();
    const EditLog log = steered.session.ended_edits();
    Context context;
    Witness witness;
    const RunResult whole = replay(scene, log, {}, witness, context);
    EXPECT_EQ(whole.report.status, RunStatus::not_converged); // it ends before equilibrium
    EXPECT_EQ(whole.positions, steered.positions());
    for (int checkpoints : {1, 3, 6, 11, 12, 13, 14}) { // the twelfth is refined
        Context stopped;
        Interrupter interrupter(stopped, checkpoints);
        EXPECT_EQ(replay(scene, log, {}, interrupter, stopped).report.status, RunStatus::interrupted);
        Context resumed;
        Witness rest;
        RunOptions options;
        options.resume = &interrupter.last;
        EXPECT_EQ(replay(scene, log, options, rest, resumed).positions, whole.positions) << checkpoints;
    }
}

TEST(Replay, RefusesEditsThatNeedANewRun) {
    const EditLog log{std::make_shared<const Edit>(Edit{Edit::Kind::set, 0, 1, "/hierarchy/levels", 3})};
    Context context;
    Witness witness;
    EXPECT_THROW(replay(small_scene(), log, {}, witness, context), InputError);
}

TEST(Replay, ReadsNoFileThatAnEditNames) {
    const EditLog log{std::make_shared<const Edit>(Edit{Edit::Kind::set, 0, 1, "/bodies/0/mesh", "secret.obj"})};
    Context context;
    Witness witness;
    try {
        replay(small_scene(), log, {}, witness, context);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("cannot take over"), std::string::npos) << error.what();
    }
}

} // namespace
