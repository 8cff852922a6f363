#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include <plisse/base/parallel.h>

#include "small_models.h"
#include "witness.h"

using namespace plisse;

namespace {

TEST(Run, DrapesProgressivelyWithoutAnIntersection) {
    const Model model = small_drape();
    Witness witness;
    const RunResult result = run_to_end(model, witness);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_EQ(result.level, 2);
    EXPECT_EQ(result.positions.cols(), model.mesh.vertex_count());
    EXPECT_EQ(witness.intersections, 0);
    EXPECT_EQ(result.report.intersecting_pairs, 0);
    EXPECT_GT(result.report.levels.back().energy.contact, 0);
    for (const LevelReport& level : result.report.levels)
        EXPECT_TRUE(level.equilibrium) << level.level;
    const auto off = [&](std::size_t level) { return result.report.levels[level].to_final; };
    EXPECT_LT(off(1).mean, off(0).mean);
    EXPECT_LT(off(0).mean, off(0).largest);
    EXPECT_TRUE(std::isinf(off(2).mean));
    // The ball carries the cloth's weight, on every level.
    const Material& material = model.bodies[0].material;
    const double weight = 0.36 * material.thickness * material.density * 9.81;
    EXPECT_EQ(result.report.reactions[1].force, result.report.levels[2].reactions[1].force);
    for (const LevelReport& level : result.report.levels)
        EXPECT_NEAR(level.reactions[1].force.y(), weight, 1e-2 * weight) << level.level;
}

TEST(Run, PressesABallWithPlatesThatArrive) {
    const Model model = small_press();
    Witness witness;
    const RunResult result = run_to_end(model, witness);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_TRUE(result.report.lagging.empty());
    EXPECT_EQ(witness.intersections, 0);
    for (const Obstacle& plate : model.obstacles)
        for (int v = plate.vertices.begin; v < plate.vertices.end; ++v) {
            const Vec3 scripted = plate.motion.apply(model.mesh.positions.col(v), model.solve.duration);
            EXPECT_LT((result.positions.col(v) - scripted).norm(), 1e-9);
        }
    const double up = result.report.reactions[0].force.y(), down = result.report.reactions[1].force.y();
    EXPECT_LT(up, -1e-3); // the upper plate is held down
    EXPECT_NEAR(up, -down, 1e-2 * std::abs(up));
}

TEST(Run, GivesTheSameBitsOnAnyNumberOfThreads) {
    const Model model = small_drape();
    Positions first;
    for (int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        Witness witness;
        const RunResult result = run_to_end(model, witness);
        if (threads == 1)
            first = result.positions;
        else
            EXPECT_EQ(first, result.positions);
    }
}

TEST(Run, ResumesToTheSameBits) {
    const Model model = small_press();
    Witness whole;
    const RunResult uninterrupted = run_to_end(model, whole);
    for (int checkpoints : {3, 9}) {
        Context context;
        Witness cut(&context, checkpoints);
        const RunResult interrupted = run(model, {}, cut, context);
        EXPECT_EQ(interrupted.report.status, RunStatus::interrupted);
        RunOptions options;
        options.resume = &*cut.last;
        Witness rest;
        const RunResult resumed = run_to_end(model, rest, options);
        EXPECT_EQ(resumed.report.status, RunStatus::converged);
        EXPECT_EQ(resumed.positions, uninterrupted.positions);
        for (std::size_t level = 0; level < resumed.report.levels.size(); ++level) {
            const LevelReport &again = resumed.report.levels[level], &once = uninterrupted.report.levels[level];
            EXPECT_EQ(again.to_final.largest, once.to_final.largest);
            EXPECT_EQ(again.too_coarse.share, once.too_coarse.share);
            EXPECT_EQ(again.too_coarse.place, once.too_coarse.place);
            EXPECT_EQ(again.estimated_turn, once.estimated_turn);
        }
    }
}

TEST(Run, StaysAtRestWithoutLoads) {
    for (Method method : {Method::progressive, Method::direct}) {
        Model model = empty_model("rest");
        add_body(model, "ball", {}, sphere_mesh(0.1, 0.03));
        model.gravity = Track<Vec3>(Vec3::Zero());
        model.contact.distance = 0.05; // far above the edges
        model.hierarchy = {3, 60};
        model.solve.method = method;
        model.solve.time_step = 0.1;
        model.solve.duration = 0.3;
        Witness witness;
        const RunResult result = run_to_end(model, witness);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_LT((result.positions - model.mesh.positions).cwiseAbs().maxCoeff(), 1e-10 * 0.35);
    }
}

TEST(Run, TakesATimelineOfNoLength) {
    for (Method method : {Method::progressive, Method::direct}) {
        Model model = small_press();
        model.solve.method = method;
        model.solve.duration = 0;
        model.solve.settle = false;
        Witness witness;
        const RunResult result = run_to_end(model, witness);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_LT((result.positions - model.mesh.positions).cwiseAbs().maxCoeff(), 1e-9);
    }
}

/// Every fraction a run shows.
struct ProgressWitness : Context {
    void on_progress(const Progress& progress) override { fractions.push_back(progress.fraction); }
    std::vector<double> fractions;
};

TEST(Run, ShowsProgressThatOnlyGrows) {
    for (Method method : {Method::progressive, Method::direct}) {
        Model model = small_press();
        model.solve.method = method;
        Witness witness;
        ProgressWitness context;
        run(model, {}, witness, context);
        ASSERT_GT(context.fractions.size(), 10U);
        EXPECT_TRUE(std::is_sorted(context.fractions.begin(), context.fractions.end()));
        EXPECT_GE(context.fractions.front(), 0);
        EXPECT_LE(context.fractions.back(), 1);
        EXPECT_GT(context.fractions.back(), 0.6);
    }
}

/// How many iterations each step took.
struct IterationWitness : Recorder {
    void on_iteration(const IterationRecord& record) override { ++of_step[record.step]; }
    std::map<int, int> of_step;
};

TEST(Run, StartsAStepWhereTheLastOneLeads) {
    Model model = empty_model("dragged sheet");
    const Body& sheet = add_body(model, "sheet", {}, sheet_mesh(0.3, 0.05));
    Handle edge;
    edge.name = "edge";
    for (int v = 0; v < sheet.vertices.end; ++v)
        if (model.mesh.positions(0, v) > 0.15 - 1e-9)
            edge.vertices.push_back(v);
    const double speed = 0.1, stop = 0.4;
    edge.motion.translate.keys = {{0, Vec3::Zero()}, {stop, Vec3(speed * stop, 0, 0)}};
    model.handles.push_back(edge);
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.solve.method = Method::direct;
    model.solve.time_step = 0.05;
    model.solve.duration = 0.5;
    IterationWitness witness;
    Context context;
    const RunResult result = run(model, {}, witness, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_GT(witness.of_step[1], 0);
    for (int step = 4; step <= 8; ++step) // steady by then: the last motion is the whole answer
        EXPECT_EQ(witness.of_step[step], 0) << step;
    EXPECT_GT(witness.of_step[9], 0); // the edge stops, and the sheet does not go on
    const Positions there = model.mesh.positions.colwise() + Vec3(speed * stop, 0, 0);
    EXPECT_LT((result.positions - there).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(Run, NeverCallsACutStepConverged) {
    Model model = small_press();
    model.solve.method = Method::direct;
    model.solve.settle = false;
    model.solve.max_iterations_per_step = 1;
    Witness witness;
    EXPECT_EQ(run_to_end(model, witness).report.status, RunStatus::not_converged);
}

} // namespace
