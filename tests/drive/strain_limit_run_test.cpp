#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <plisse/base/error.h>
#include <plisse/base/parallel.h>
#include <plisse/drive/limit_relaxation.h>
#include <plisse/drive/run.h>
#include <plisse/spatial/intersections.h>

#include "small_models.h"

using namespace plisse;

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Largest singular value of the map that takes a rest triangle, laid into a plane, to where it is. Shares no code with
/// the solver.
double largest_stretch(const Positions& rest, const Positions& x, const Face& face) {
    const Vec3 r1 = rest.col(face[1]) - rest.col(face[0]), r2 = rest.col(face[2]) - rest.col(face[0]);
    const Vec3 first = r1.normalized();
    const Vec3 second = (r2 - r2.dot(first) * first).normalized();
    Mat2 flat;
    flat << r1.dot(first), r2.dot(first), r1.dot(second), r2.dot(second);
    Mat32 edges;
    edges << x.col(face[1]) - x.col(face[0]), x.col(face[2]) - x.col(face[0]);
    return Eigen::JacobiSVD<Mat32>(edges * flat.inverse()).singularValues()[0];
}

/// Over the faces of a level's bodies (parts below `bodies`).
double largest_stretch(const HierarchyLevel& level, const Positions& x, int bodies = 1) {
    double largest = 0;
    for (const Face& face : level.faces)
        if (level.part[at(face[0])] < bodies)
            largest = std::max(largest, largest_stretch(level.rest, x, face));
    return largest;
}

/// The largest stretch of all frames of each level, and how many there were; can cancel after some checkpoints.
struct StretchWitness : Recorder {
    void on_hierarchy(const Hierarchy& h) override { hierarchy = h; }
    void on_frame(const Frame& frame) override {
        const double stretch = largest_stretch(hierarchy.levels[at(frame.level)], *frame.positions);
        most[frame.level] = std::max(most[frame.level], stretch);
        ++frames;
    }
    void on_checkpoint(const Checkpoint& checkpoint) override {
        last = checkpoint;
        ++checkpoints;
        if (context && checkpoints == cancel_after)
            context->cancel();
    }
    Hierarchy hierarchy;
    std::map<int, double> most; ///< by level
    int frames = 0, checkpoints = 0, cancel_after = 0;
    Context* context = nullptr;
    std::optional<Checkpoint> last;
};

RunResult run_with(const Model& model, StretchWitness& witness, const RunOptions& options = {}) {
    Context context;
    witness.context = &context;
    return run(model, options, witness, context);
}

constexpr double limit = 1.05;

/// A cloth held by two corners under ten times gravity: without a limit it is stretched to almost twice its length
/// there.
Model hung_cloth(std::optional<double> strain_limit) {
    Model model = empty_model("hung cloth");
    Material cotton;
    cotton.strain_limit = strain_limit;
    add_body(model, "cloth", cotton, sheet_mesh(0.6, 0.025));
    Handle corners;
    corners.name = "corners";
    for (int v = 0; v < model.mesh.vertex_count(); ++v)
        if (std::abs(model.mesh.positions(0, v)) > 0.3 - 1e-9 && model.mesh.positions(2, v) < -0.3 + 1e-9)
            corners.vertices.push_back(v);
    model.handles.push_back(corners);
    model.gravity = Track<Vec3>(Vec3(0, -98.1, 0));
    model.hierarchy = {3, 60, ProlongationOperator::shell, BendingOn::level};
    model.solve.time_step = 0.05;
    model.solve.duration = 0.3;
    model.solve.frame_interval = 0.05;
    return model;
}

/// A strip whose ends are pulled apart by a quarter of its length and held there.
Model pulled_strip(double strain_limit, double pull) {
    Model model = empty_model("pulled strip");
    Material rubber{930, 1.5e6, 0.4, 5e-4, 1};
    rubber.strain_limit = strain_limit;
    const double length = 0.2;
    add_body(model, "strip", rubber, sheet_mesh(length, 0.03));
    for (double side : {-1.0, 1.0}) {
        Handle end;
        end.name = side < 0 ? "left" : "right";
        for (int v = 0; v < model.mesh.vertex_count(); ++v)
            if (side * model.mesh.positions(0, v) > length / 2 - 1e-9)
                end.vertices.push_back(v);
        end.motion.translate.keys = {{0, Vec3::Zero()}, {0.5, Vec3(side * pull * length / 2, 0, 0)}};
        model.handles.push_back(end);
    }
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.hierarchy = {2, 20};
    model.solve.time_step = 0.1;
    model.solve.duration = 0.6;
    model.solve.frame_interval = 0.1;
    model.solve.max_settle_steps = 20;
    return model;
}

TEST(StrainLimitRun, NoFrameOfAnyLevelPassesTheLimitUnderTenTimesGravity) {
    Model model = hung_cloth(limit);
    StretchWitness progressive;
    const RunResult fine = run_with(model, progressive);
    EXPECT_EQ(fine.report.status, RunStatus::converged) << fine.report.message;
    EXPECT_EQ(progressive.most.size(), 3u);
    EXPECT_GT(progressive.frames, 10);
    int over_limit = 0;
    for (const RefinementReport& refinement : fine.report.refinements)
        over_limit += refinement.over_limit;
    EXPECT_GT(over_limit, 0) << "refined levels must need to be brought within the limit for this to be a test";
    for (const auto& [level, stretch] : progressive.most) {
        EXPECT_LT(stretch, limit) << level;
        EXPECT_GT(stretch, 1.025) << level << ": the barrier must act for this to be a test";
    }
    for (const LevelReport& level : fine.report.levels) {
        EXPECT_LT(level.max_stretch, limit);
        EXPECT_GT(level.energy.strain_limit, 0);
    }
    model.solve.method = Method::direct;
    for (std::optional<int> level : {std::optional<int>(), std::optional(0), std::optional(1)}) {
        model.solve.level = level;
        StretchWitness direct;
        const RunResult result = run_with(model, direct);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        ASSERT_EQ(direct.most.size(), 1u);
        EXPECT_LT(direct.most.begin()->second, limit);
        EXPECT_GT(direct.most.begin()->second, 1.025);
        if (!level) {
            EXPECT_LT((result.positions - fine.positions).colwise().norm().maxCoeff(), 1e-3);
        }
    }
}

TEST(StrainLimitRun, HoldsATightLimitToo) {
    constexpr double tight = 1.002;
    Model model = hung_cloth(tight);
    model.solve.method = Method::direct;
    model.solve.level = 0;
    StretchWitness witness;
    const RunResult result = run_with(model, witness);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_LT(witness.most.at(0), tight);
    EXPECT_GT(witness.most.at(0), 1.001);
}

TEST(StrainLimitRun, WithoutALimitTheSameClothIsStretchedFarBeyondIt) {
    StretchWitness witness;
    run_with(hung_cloth(std::nullopt), witness);
    for (const auto& [level, stretch] : witness.most)
        EXPECT_GT(stretch, 1.1) << level;
}

TEST(StrainLimitRun, ALimitThatIsNeverNearChangesNoBit) {
    StretchWitness without, with;
    EXPECT_EQ(run_with(hung_cloth(std::nullopt), without).positions, run_with(hung_cloth(9.0), with).positions);
}

TEST(StrainLimitRun, GivesTheSameBitsOnAnyNumberOfThreadsAndWhenResumed) {
    const Model model = hung_cloth(limit);
    StretchWitness whole;
    const Positions end = run_with(model, whole).positions;
    for (int threads : {1, 2}) {
        const ThreadLimit thread_limit(threads);
        StretchWitness witness;
        EXPECT_EQ(run_with(model, witness).positions, end) << threads;
    }
    for (int after : {3, whole.checkpoints / 2, whole.checkpoints - 2}) {
        StretchWitness cut;
        cut.cancel_after = after;
        run_with(model, cut);
        RunOptions options;
        options.resume = &*cut.last;
        StretchWitness rest;
        rest.hierarchy = whole.hierarchy;
        EXPECT_EQ(run_with(model, rest, options).positions, end) << after;
    }
}

TEST(StrainLimitRun, StaysAtRestWithoutLoads) {
    for (Method method : {Method::progressive, Method::direct}) {
        Model model = empty_model("rest");
        Material material;
        material.strain_limit = 1.001;
        add_body(model, "ball", material, sphere_mesh(0.1, 0.03));
        model.gravity = Track<Vec3>(Vec3::Zero());
        model.hierarchy = {3, 60};
        model.solve.method = method;
        model.solve.duration = 0.2;
        StretchWitness witness;
        const RunResult result = run_with(model, witness);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_LT((result.positions - model.mesh.positions).cwiseAbs().maxCoeff(), 1e-10 * 0.35);
    }
}

TEST(StrainLimitRun, AScriptWithinTheLimitIsFollowed) {
    for (Method method : {Method::progressive, Method::direct}) {
        Model model = pulled_strip(1.1, 0.06);
        model.solve.method = method;
        StretchWitness witness;
        const RunResult result = run_with(model, witness);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_TRUE(result.report.lagging.empty());
        for (const auto& [level, stretch] : witness.most)
            EXPECT_LT(stretch, 1.1) << level;
    }
}

TEST(StrainLimitRun, AScriptBeyondTheLimitLagsAndNothingPassesIt) {
    for (Method method : {Method::progressive, Method::direct}) {
        Model model = pulled_strip(1.1, 0.25);
        model.solve.method = method;
        StretchWitness witness;
        const RunResult result = run_with(model, witness);
        EXPECT_EQ(result.report.status, RunStatus::not_converged);
        EXPECT_FALSE(result.report.lagging.empty());
        for (const Lag& lag : result.report.lagging)
            EXPECT_GT(lag.distance, 5e-3);
        for (const auto& [level, stretch] : witness.most) {
            EXPECT_LT(stretch, 1.1) << level;
            EXPECT_GT(stretch, 1.075) << level;
        }
    }
}

TEST(StrainLimitRun, RefusesAStartBeyondTheLimitWithItsPlace) {
    Model model = hung_cloth(limit);
    model.start.row(0) *= 1.06;
    StretchWitness witness;
    Context context;
    try {
        run(model, {}, witness, context);
        FAIL() << "it ran";
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("\"cloth\" near ("), std::string::npos) << message;
        EXPECT_NE(message.find("to 1.06, and its limit is 1.05"), std::string::npos) << message;
    }
    model.start.row(0) *= 1.04 / 1.06;
    model.solve.settle = false;
    model.solve.duration = 0.05;
    EXPECT_NO_THROW(run(model, {}, witness, context));
}

/// New vertices alone move where they can do it, and the state stays free of intersections.
TEST(LimitRelaxation, MovesNewVerticesFirst) {
    const Model model = hung_cloth(limit);
    Context context;
    const Discretization discretization(model, 3, context);
    const HierarchyLevel& level = discretization.mesh(1);
    Positions x = discretization.start(1);
    std::vector<std::uint8_t> is_new(level.part.size(), 0);
    const Vec3 center = Vec3(0.02, 0, 0.03);
    int moved = 0;
    for (int v = 1; v < x.cols(); ++v)
        if ((level.rest.col(v) - center).squaredNorm() < (level.rest.col(moved) - center).squaredNorm())
            moved = v;
    is_new[at(moved)] = 1;
    const Positions before = x;
    x.col(moved) += Vec3(0.01, 0.03, 0.01);
    ASSERT_GT(largest_stretch(level, x), 1.1);
    const LimitRelaxationResult result = relax_to_strain_limits(discretization, 1, is_new, x, context);
    EXPECT_TRUE(result.within) << result.message;
    EXPECT_GT(result.over_limit, 0);
    EXPECT_GT(result.iterations, 0);
    EXPECT_LT(largest_stretch(level, x), limit);
    for (int v = 0; v < x.cols(); ++v)
        if (v != moved) {
            EXPECT_EQ(Vec3(x.col(v)), Vec3(before.col(v)));
        }
}

TEST(LimitRelaxation, MovesAllWhereNewVerticesAreNotEnough) {
    const Model model = hung_cloth(limit);
    Context context;
    const Discretization discretization(model, 3, context);
    const HierarchyLevel& level = discretization.mesh(1);
    for (double stretch : {1.07, 1.5}) { // the corners must let go of the script
        Positions x = discretization.start(1);
        x.row(0) *= stretch;
        const LimitRelaxationResult result =
            relax_to_strain_limits(discretization, 1, std::vector<std::uint8_t>(level.part.size(), 0), x, context);
        EXPECT_TRUE(result.within) << result.message;
        EXPECT_LT(largest_stretch(level, x), limit) << stretch;
        EXPECT_TRUE(intersecting_pairs(x, level.faces, {}).empty());
    }
}

/// A skin around a ball that is too large for it.
TEST(LimitRelaxation, SaysWhatCannotBeBroughtWithin) {
    Model model = empty_model("skin");
    Material material;
    material.strain_limit = 1.1;
    add_body(model, "skin", material, sphere_mesh(0.1, 0.04));
    Obstacle ball;
    ball.name = "ball";
    append_part(model, sphere_mesh(0.115, 0.04), Vec3::Zero(), ball.vertices, ball.faces);
    model.obstacles.push_back(ball);
    model.hierarchy = {1, 60};
    Context context;
    const Discretization discretization(model, 1, context);
    const HierarchyLevel& level = discretization.mesh(0);
    Positions x = level.rest;
    x.leftCols(model.bodies[0].vertices.end) *= 1.25;
    const LimitRelaxationResult result =
        relax_to_strain_limits(discretization, 0, std::vector<std::uint8_t>(level.part.size(), 1), x, context);
    EXPECT_FALSE(result.within);
    EXPECT_NE(result.message.find("one of \"skin\" near ("), std::string::npos) << result.message;
    const auto of_ball = [&](int a, int b) {
        const auto part = [&](int f) { return level.part[at(level.faces[at(f)][0])]; };
        return part(a) == 1 && part(b) == 1;
    };
    EXPECT_TRUE(intersecting_pairs(x, level.faces, of_ball).empty());
}

/// A cloth of limited stretch and of some thickness pulled down over a ball by five times gravity, its crown held.
TEST(StrainLimitRun, KeepsTheContactThicknessToo) {
    Model model = small_drape();
    model.bodies[0].material.strain_limit = 1.02;
    model.contact.thickness = 2e-3;
    model.gravity = Track<Vec3>(Vec3(0, -49, 0));
    StretchWitness witness;
    Context context;
    const RunResult result = run(model, {}, witness, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_EQ(result.report.intersecting_pairs, 0);
    ASSERT_EQ(witness.most.size(), 3U);
    for (const auto& [level, stretch] : witness.most)
        EXPECT_LT(stretch, 1.02) << level;
    for (const LevelReport& level : result.report.levels)
        EXPECT_GT(level.min_gap, 0); // beyond the thickness
    EXPECT_GT(result.report.levels.back().energy.strain_limit, 0);
    EXPECT_GT(result.report.levels.back().energy.contact, 0);
}

} // namespace
