#include <gtest/gtest.h>

#include <optional>

#include <plisse/drive/run.h>
#include <plisse/model/shell_problem.h>

#include "small_models.h"

using namespace plisse;

namespace {

constexpr double least_gap_share = 1e-3; // docs/decisions/0017
constexpr double distance = 1e-3;

/// A cloth on a floor, with a growing load on its middle, on two levels.
Model loaded_cloth(double load) {
    Model model = empty_model("loaded cloth");
    add_body(model, "cloth", {472.6, 8.21e5, 0.243, 3.18e-4, 1}, sheet_mesh(0.2, 0.03), Vec3(0, 0.002, 0));
    Load weight{Load::Kind::force, 0, {}, {}};
    for (int v = 0; v < model.mesh.vertex_count(); ++v)
        if (Vec3(model.mesh.positions.col(v) - Vec3(0, 0.002, 0)).norm() < 0.03)
            weight.vertices.push_back(v);
    weight.value.keys = {{0, Vec3::Zero()}, {0.5, Vec3(0, -load, 0)}};
    model.loads.push_back(weight);
    Obstacle floor;
    floor.name = "floor";
    append_part(model, sheet_mesh(0.4, 0.1), Vec3::Zero(), floor.vertices, floor.faces);
    model.obstacles.push_back(floor);
    model.contact.distance = distance;
    model.contact.friction = 0.3;
    model.hierarchy = {2, 20};
    model.solve.time_step = 0.1;
    model.solve.duration = 0.5;
    return model;
}

/// A cloth between plates that leave it a millionth of a metre.
Model cloth_in_a_vise() {
    Model model = empty_model("vise");
    add_body(model, "cloth", {472.6, 8.21e5, 0.243, 3.18e-4, 1}, sheet_mesh(0.2, 0.04));
    for (double side : {1.0, -1.0}) {
        Obstacle plate;
        plate.name = side > 0 ? "upper" : "lower";
        plate.motion.translate.keys = {{0, Vec3::Zero()}, {0.5, Vec3(0, (5e-7 - 2 * distance) * side, 0)}};
        append_part(model, sheet_mesh(0.3, 0.1), Vec3(0, 2 * distance * side, 0), plate.vertices, plate.faces);
        model.obstacles.push_back(plate);
    }
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.contact.distance = distance;
    model.solve.method = Method::direct;
    model.solve.time_step = 0.1;
    model.solve.duration = 0.5;
    return model;
}

/// Keeps what a run says of its barrier; can cancel it when that has been stiffened, some checkpoints later.
struct Witness : Recorder {
    void on_stiffening(const StiffeningRecord& record) override { changes.push_back(record); }
    void on_checkpoint(const Checkpoint& checkpoint) override {
        last = checkpoint;
        if (context && !changes.empty() && left-- == 0)
            context->cancel();
    }
    Context* context = nullptr;
    int left = 0;
    std::vector<StiffeningRecord> changes;
    std::optional<Checkpoint> last;
};

TightestPair tightest_at_the_end(const Model& model, const RunResult& result) {
    Context context;
    const Discretization discretization(model, model.hierarchy.levels, context);
    ShellProblem problem(discretization, discretization.finest(), EnergiesOf::finest, context);
    return problem.tightest_pair(as_vector(result.positions));
}

TEST(BarrierStiffness, GrowsWithTheLoadAndKeepsSurfacesApart) {
    for (double load : {1e5, 1e6}) {
        const Model model = loaded_cloth(load);
        Witness witness;
        Context context;
        const RunResult result = run(model, {}, witness, context);
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        for (const LevelReport& level : result.report.levels) {
            EXPECT_TRUE(level.equilibrium);
            EXPECT_LE(level.residual, 1e-3);
        }
        ASSERT_FALSE(witness.changes.empty());
        const double factor = witness.last->stiffness_factor, share = tightest_at_the_end(model, result).share;
        EXPECT_EQ(factor, witness.changes.back().factor);
        EXPECT_GE(share, least_gap_share);
        EXPECT_LT(share / factor, least_gap_share) << "where it would be with the barrier as it was";
    }
}

TEST(BarrierStiffness, SaysWhatChangesItAndWhere) {
    Witness witness;
    Context context;
    run(loaded_cloth(1e6), {}, witness, context);
    double factor = 1;
    for (const StiffeningRecord& change : witness.changes) {
        EXPECT_LT(change.gap_share, least_gap_share);
        EXPECT_GE(change.factor, 10 * factor) << "never by little, over and over";
        EXPECT_NE(change.pair.find(" of floor are "), std::string::npos) << change.pair;
        factor = change.factor;
    }
    EXPECT_LE(witness.changes.size(), 2u);
}

TEST(BarrierStiffness, ResumesToTheSameBits) {
    const Model model = loaded_cloth(1e6);
    Witness whole;
    Context uncancelled;
    const RunResult uninterrupted = run(model, {}, whole, uncancelled);
    for (int checkpoints : {0, 3}) {
        Context context;
        Witness cut;
        cut.context = &context;
        cut.left = checkpoints;
        EXPECT_EQ(run(model, {}, cut, context).report.status, RunStatus::interrupted);
        EXPECT_GT(cut.last->stiffness_factor, 1);
        RunOptions options;
        options.resume = &*cut.last;
        Witness rest;
        const RunResult resumed = run(model, options, rest, uncancelled);
        EXPECT_EQ(resumed.positions, uninterrupted.positions);
        EXPECT_EQ(rest.last->stiffness_factor, whole.last->stiffness_factor);
        EXPECT_EQ(cut.changes.size() + rest.changes.size(), whole.changes.size());
    }
}

TEST(BarrierStiffness, StaysWhereNothingIsPressedTooHard) {
    for (const Model& model : {small_press(), small_drape(), loaded_cloth(1e3)}) {
        Witness witness;
        Context context;
        EXPECT_EQ(run(model, {}, witness, context).report.status, RunStatus::converged);
        EXPECT_TRUE(witness.changes.empty());
        EXPECT_EQ(witness.last->stiffness_factor, 1);
    }
}

TEST(BarrierStiffness, StaysWhereScriptsLeaveNoMoreRoom) {
    const Model model = cloth_in_a_vise();
    Witness witness;
    Context context;
    const RunResult result = run(model, {}, witness, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_LT(tightest_at_the_end(model, result).share, least_gap_share);
    EXPECT_EQ(witness.last->stiffness_factor, 1);
    EXPECT_EQ(witness.changes.size(), 2u) << "one try, taken back";
    EXPECT_FALSE(witness.last->stiffening_helps);
}

} // namespace
