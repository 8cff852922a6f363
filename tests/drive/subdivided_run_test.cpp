#include <gtest/gtest.h>

#include <cmath>

#include <plisse/base/parallel.h>
#include <plisse/drive/refinement_targets.h>
#include <plisse/drive/subdivided_state.h>
#include <plisse/spatial/intersections.h>

#include "small_models.h"
#include "witness.h"

using namespace plisse;

namespace {

void subdivide_by_loop(Model& model, int levels) {
    model.hierarchy.levels = levels;
    model.hierarchy.source = HierarchySource::loop;
    model.hierarchy.prolongation = ProlongationOperator::loop;
}

/// A square of cloth whose left and right edges are turned against each other until it touches itself.
Model small_twist() {
    Model model = empty_model("small twist");
    const Body& cloth = add_body(model, "cloth", {472.6, 8.21e4, 0.243, 3.18e-4, 3}, sheet_mesh(0.4, 0.08));
    for (double side : {-1.0, 1.0}) {
        Handle handle;
        handle.name = side < 0 ? "left" : "right";
        for (int v = 0; v < cloth.vertices.end; ++v)
            if (side * model.mesh.positions(0, v) > 0.2 - 1e-9)
                handle.vertices.push_back(v);
        handle.motion.rotate_deg.keys = {{0, Vec3::Zero()}, {2, Vec3(-side * 150, 0, 0)}};
        model.handles.push_back(handle);
    }
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.contact.distance = 2e-3;
    model.solve.time_step = 0.1;
    model.solve.duration = 2;
    model.solve.frame_interval = 0.5;
    subdivide_by_loop(model, 3);
    return model;
}

/// A ball of cloth with an obstacle inside.
Model filled_ball() {
    Model model = empty_model("filled ball");
    add_body(model, "ball", {}, sphere_mesh(0.3, 0.25));
    Obstacle inside;
    inside.name = "inside";
    append_part(model, sphere_mesh(0.076, 0.02), Vec3::Zero(), inside.vertices, inside.faces);
    model.obstacles.push_back(inside);
    model.contact.distance = 2e-3;
    subdivide_by_loop(model, 3);
    return model;
}

TEST(SubdividedState, ArrivesWhereNothingIsInTheWay) {
    const Model model = small_twist();
    Context context;
    const Discretization discretization(model, 2, context);
    Positions x = discretization.start(0);
    for (Eigen::Index v = 0; v < x.cols(); ++v)
        x(1, v) = 0.05 * std::sin(15 * x(0, v));
    const SubdividedState state = subdivide_state(discretization, 0, x, 0);
    EXPECT_EQ(state.stopped_vertices, 0);
    EXPECT_EQ(state.new_vertices, discretization.mesh(1).rest.cols() - x.cols());
    EXPECT_LT((state.positions - refinement_targets(discretization, 0, x, 0)).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SubdividedState, StopsWhereItWouldMeetSomething) {
    const Model model = filled_ball();
    Context context;
    const Discretization discretization(model, 3, context);
    for (int from : {0, 1}) {
        Positions x = discretization.start(from);
        const int of_ball = static_cast<int>(x.cols()) - model.obstacles[0].vertices.size();
        // So small that what the ball smooths to lies within the obstacle, though the ball itself does not.
        double scale = 1;
        const auto shrunk = [&](double s) {
            Positions y = x;
            y.leftCols(of_ball) *= s;
            return y;
        };
        const HierarchyLevel &coarse = discretization.mesh(from), &fine = discretization.mesh(from + 1);
        const auto on_obstacle = [&](int a, int b) {
            const auto& part = discretization.layout(from).face_part;
            return part[static_cast<std::size_t>(a)] == 1 && part[static_cast<std::size_t>(b)] == 1;
        };
        while (intersecting_pairs(shrunk(0.98 * scale), coarse.faces, on_obstacle, 1).empty())
            scale *= 0.98;
        x = shrunk(scale);
        EXPECT_GT(count_intersections(refinement_targets(discretization, from, x, 0), fine, 1), 0);
        const SubdividedState state = subdivide_state(discretization, from, x, 0);
        EXPECT_GT(state.stopped_vertices, 0);
        EXPECT_GT(state.min_gap, 0);
        EXPECT_EQ(count_intersections(state.positions, fine, 1), 0);
    }
}

TEST(SubdividedRun, TwistsToTheEndWithoutAnIntersection) {
    const Model model = small_twist();
    std::optional<Positions> first;
    for (int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        Witness witness;
        const RunResult result = run_to_end(model, witness);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_EQ(witness.intersections, 0);
        EXPECT_EQ(witness.refined, 2);
        EXPECT_EQ(result.positions.cols(), witness.hierarchy.finest().rest.cols());
        EXPECT_GT(result.report.levels.back().energy.contact, 0);
        EXPECT_LT(result.report.levels[1].to_final.mean, result.report.levels[0].to_final.mean);
        EXPECT_TRUE(result.report.lagging.empty());
        if (!first)
            first = result.positions;
        EXPECT_EQ(result.positions, *first);
    }
}

TEST(SubdividedRun, DrapesByLoopAndByShell) {
    using P = ProlongationOperator;
    for (P kind : {P::loop, P::shell}) {
        Model model = empty_model("coarse drape");
        const Body& cloth = add_body(model, "cloth", {}, sheet_mesh(0.6, 0.12), Vec3(0, 0.17, 0));
        const Model fine = small_drape();
        Obstacle ball = fine.obstacles[0];
        append_part(model, sphere_mesh(0.15, 0.05), Vec3::Zero(), ball.vertices, ball.faces);
        model.obstacles.push_back(ball);
        Handle crown = fine.handles[0];
        crown.vertices.clear();
        for (int v = 0; v < cloth.vertices.end; ++v)
            if ((model.mesh.positions.col(v) - Vec3(0, 0.17, 0)).norm() < 0.09)
                crown.vertices.push_back(v);
        ASSERT_FALSE(crown.vertices.empty());
        model.handles.push_back(crown);
        model.contact = fine.contact;
        model.solve = fine.solve;
        subdivide_by_loop(model, 2);
        model.hierarchy.prolongation = kind;
        Witness witness;
        const RunResult result = run_to_end(model, witness);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_EQ(witness.intersections, 0);
        const double weight = 0.36 * model.bodies[0].material.thickness * model.bodies[0].material.density * 9.81;
        EXPECT_NEAR(result.report.reactions[1].force.y(), weight, 1e-2 * weight);
    }
}

TEST(SubdividedRun, ResumesToTheSameBits) {
    Model model = small_twist();
    model.solve.duration = 0.5;
    model.hierarchy.levels = 2;
    Witness whole;
    const RunResult uninterrupted = run_to_end(model, whole);
    for (int checkpoints : {3, 7}) {
        Context context;
        Witness cut(&context, checkpoints);
        EXPECT_EQ(run(model, {}, cut, context).report.status, RunStatus::interrupted);
        RunOptions options;
        options.resume = &*cut.last;
        Witness rest;
        EXPECT_EQ(run_to_end(model, rest, options).positions, uninterrupted.positions);
    }
}

TEST(SubdividedRun, DirectIsOnTheFinestLevelUnlessAnotherIsAskedFor) {
    Model model = small_twist();
    model.solve.method = Method::direct;
    model.solve.duration = 0.1;
    for (std::optional<int> level : {std::optional<int>(), std::optional<int>(0)}) {
        model.solve.level = level;
        Witness witness;
        const RunResult result = run_to_end(model, witness);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_EQ(result.level, level.value_or(2));
        EXPECT_EQ(result.positions.cols(),
                  witness.hierarchy.levels.at(static_cast<std::size_t>(result.level)).rest.cols());
    }
}

} // namespace
