#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include <plisse/scene/build_model.h>
#include <plisse/scene/read_scene.h>

#include "scene/judge.h"

namespace {

using namespace plisse;

/// A scene of examples/psq, run to its end.
struct Experiment {
    Context context;
    Scene scene;
    Model model;
    Judge judge;
    RunResult result;

    explicit Experiment(const std::string& name)
        : scene(read_scene(std::filesystem::path(PLISSE_SOURCE_DIR) / "examples/psq" / (name + ".json"))),
          model(build_model(scene, context)), judge(static_cast<int>(model.bodies.size())),
          result(run(model, {}, judge, context)) {
        EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        EXPECT_EQ(judge.intersections, 0);
        EXPECT_EQ(judge.last.size(), judge.hierarchy.levels.size());
    }

    /// The height of every vertex of bodies in a level's last frame.
    VecX heights(int level) const {
        const std::vector<int>& part = judge.hierarchy.levels[static_cast<std::size_t>(level)].part;
        const Positions& x = judge.last.at(level);
        std::vector<double> y;
        for (int v = 0; v < x.cols(); ++v)
            if (!model.is_obstacle(part[static_cast<std::size_t>(v)]))
                y.push_back(x(1, v));
        return Eigen::Map<VecX>(y.data(), static_cast<Eigen::Index>(y.size()));
    }
};

TEST(Psq, PlateBucklesTheSameWayOnEveryLevel) {
    const Experiment plate("plate_buckling");
    const double sag = plate.heights(3).minCoeff();
    EXPECT_LT(sag, -0.01);
    for (const int level : {0, 1, 2}) {
        EXPECT_NEAR(plate.heights(level).minCoeff(), sag, 0.03 * std::abs(sag)) << level;
        EXPECT_LT(plate.heights(level).maxCoeff(), 1e-3) << level;
    }
}

TEST(Psq, DomeStaysInvertedOnEveryLevel) {
    const Experiment dome("dome_inversion"); // at rest its rim is 25 mm below the origin, and its apex as far above
    for (const int level : {0, 1, 2, 3}) {
        EXPECT_NEAR(dome.heights(level).minCoeff(), -0.075, 2e-3) << level;
        EXPECT_LT(dome.heights(level).maxCoeff(), -0.024) << level;
    }
}

TEST(Psq, PlateShearsTheSameWayOnEveryLevel) {
    const Experiment plate("plate_shearing");
    const double fold = plate.heights(3).maxCoeff() - plate.heights(3).minCoeff();
    EXPECT_GT(fold, 0.01);
    for (const int level : {0, 1, 2})
        EXPECT_LT(plate.result.report.levels[static_cast<std::size_t>(level)].to_final.mean, 0.1 * fold) << level;
}

TEST(SlowPsq, BubbleComesOutOnEveryLevel) {
    const Experiment balloon("bubble_balloon"); // the balloon's own top is at 93 mm
    for (const int level : {0, 1, 2})
        EXPECT_GT(balloon.heights(level).maxCoeff() - balloon.heights(level).minCoeff(), 0.24) << level;
}

TEST(SlowPsq, BearsStayInTheirCage) {
    const Experiment cage("caged_bears");
    for (const int level : {0, 1, 2})
        EXPECT_LT(cage.judge.last.at(level).colwise().norm().maxCoeff(), 0.25) << level; // a foot may hang out
}

class PsqRun : public testing::TestWithParam<const char*> {};
TEST_P(PsqRun, ConvergesWithoutAnIntersection) {
    const Experiment experiment(GetParam());
}
INSTANTIATE_TEST_SUITE_P(Slow, PsqRun,
                         testing::Values("can_crush", "pumpkin_press", "cloth_twist", "sheet_drape", "cookie_cutter"));

} // namespace
