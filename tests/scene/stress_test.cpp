#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

#include <plisse/scene/build_model.h>
#include <plisse/scene/read_scene.h>

#include "scene/judge.h"

namespace {

using namespace plisse;

using Reduce = std::function<void(Scene&)>;

/// Runs a stress scene with a frame of every step. Whatever the end, nothing intersects on the way.
RunReport run_scene(const std::string& name, const Reduce& reduce) {
    Scene scene = read_scene(std::filesystem::path(PLISSE_SOURCE_DIR) / "examples/stress" / (name + ".json"));
    reduce(scene);
    scene.solve.frame_interval = scene.solve.time_step;
    Context context;
    const Model model = build_model(scene, context);
    Judge judge(static_cast<int>(model.bodies.size()));
    const RunResult result = run(model, {}, judge, context);
    EXPECT_EQ(judge.intersections, 0);
    EXPECT_EQ(result.report.intersecting_pairs, 0);
    EXPECT_GT(judge.frames, scene.solve.duration / scene.solve.time_step - 1e-9);
    std::printf("%s: %d vertices, %d iterations, %.1f s, %s\n", name.c_str(), model.mesh.vertex_count(),
                judge.iterations, result.report.wall_seconds, result.report.message.c_str());
    return result.report;
}

void expect_arrived(const RunReport& report) {
    EXPECT_EQ(report.status, RunStatus::converged) << report.message;
    EXPECT_TRUE(report.lagging.empty());
}

/// Either everything arrived, or the report says what did not.
void expect_clear_end(const RunReport& report) {
    if (report.status == RunStatus::converged)
        return;
    EXPECT_EQ(report.status, RunStatus::not_converged);
    EXPECT_FALSE(report.message.empty());
    for (const Lag& lag : report.lagging) {
        EXPECT_GT(lag.distance, 0) << lag.name;
        int vertices = 0;
        for (const auto& [first, last] : lag.ranges)
            vertices += last - first + 1;
        EXPECT_EQ(vertices, lag.vertices) << lag.name;
    }
}

void expect_lag_of_ball_and_block(const RunReport& report) {
    expect_clear_end(report);
    EXPECT_EQ(report.status, RunStatus::not_converged);
    ASSERT_EQ(report.lagging.size(), 2U);
    EXPECT_EQ(report.lagging[0].name, "ball");
    EXPECT_EQ(report.lagging[1].name, "block");
    EXPECT_NE(report.message.find("contact"), std::string::npos) << report.message;
    EXPECT_GT(report.levels.back().min_gap, 1e-8); // blocked, not squeezed to nothing
}

/// Coarser meshes with contact and time steps to match.
Reduce coarser(double factor, double time_step) {
    return [=](Scene& scene) {
        for (BodySpec& body : scene.bodies)
            body.mesh.generator.edge_length *= factor;
        scene.contact.distance *= std::min(factor, 2.0);
        scene.solve.time_step = time_step;
    };
}

TEST(Stress, ClothIsPulledThroughAFunnel) {
    expect_arrived(run_scene("funnel", coarser(4, 0.1)));
}

TEST(Stress, ClothIsPulledThroughARing) {
    expect_arrived(run_scene("ring", [](Scene& scene) {
        coarser(3, 0.08)(scene);
        scene.hierarchy.coarsest_vertices = 250;
    }));
}

TEST(Stress, SheetIsSweptByAFastBlade) {
    expect_clear_end(run_scene("fast_sweep", coarser(3, 0.02)));
}

TEST(Stress, BearIsSqueezedTo40Percent) {
    expect_arrived(run_scene("character_squeeze", [](Scene& scene) {
        scene.hierarchy.coarsest_vertices = 300;
        scene.solve.method = Method::direct;
        scene.solve.level = 0;
        scene.solve.settle = false;
        scene.solve.time_step = 0.05;
        scene.contact.distance = 2e-3;
    }));
}

TEST(Stress, ClothIsTrappedBetweenBallAndBlock) {
    expect_lag_of_ball_and_block(run_scene("trapped", [](Scene& scene) {
        coarser(3, 0.1)(scene);
        scene.solve.settle = true;
    }));
}

TEST(Stress, FiveLayersAreCrumpledIntoABox) {
    expect_arrived(run_scene("crumple_box", coarser(3, 0.08)));
}

TEST(Stress, TwistOfThreeTurnsEach) {
    expect_arrived(run_scene("twist_direct", coarser(4, 0.5)));
}

TEST(Stress, TwistOfOneTurnEachIsRefined) {
    expect_arrived(run_scene("twist_progressive", [](Scene& scene) {
        coarser(6, 0.5)(scene);
        scene.hierarchy.coarsest_vertices = 200;
        scene.solve.duration = 5;
    }));
}

struct FullScene {
    const char* name;
    void (*expect_end)(const RunReport&);
    friend void PrintTo(const FullScene& scene, std::ostream* out) { *out << scene.name; }
};

class SlowStress : public testing::TestWithParam<FullScene> {};

TEST_P(SlowStress, EndsAsItMust) {
    const auto& [name, expect_end] = GetParam();
    expect_end(run_scene(name, [](Scene&) {}));
}

INSTANTIATE_TEST_SUITE_P(
    , SlowStress,
    testing::Values(FullScene{"funnel", expect_arrived}, FullScene{"ring", expect_arrived},
                    FullScene{"fast_sweep", expect_clear_end}, FullScene{"character_squeeze", expect_arrived},
                    FullScene{"trapped", expect_lag_of_ball_and_block}, FullScene{"crumple_box", expect_arrived},
                    FullScene{"twist_direct", expect_arrived}, FullScene{"twist_progressive", expect_arrived}),
    [](const auto& scene) { return scene.param.name; });

} // namespace
