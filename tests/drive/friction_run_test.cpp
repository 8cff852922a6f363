#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <plisse/base/parallel.h>
#include <plisse/drive/run.h>

#include "small_models.h"

using namespace plisse;

namespace {

constexpr double g = 9.81;

/// A flat sheet just above one large triangle of a plane, as on an incline whose tangent is given: gravity leans to +x.
Model incline(double friction, double tangent) {
    Model model = empty_model("incline");
    add_body(model, "sheet", {1000, 1e7, 0.3, 1e-3, 1}, sheet_mesh(0.1, 0.03), Vec3(4, 0.998e-3, -8));
    GeneratorOptions ground;
    ground.shape = GeneratorShape::sheet;
    ground.size = Vec3(40, 40, 0);
    ground.pattern = Pattern::regular;
    ground.cells = {1, 1};
    Obstacle plane;
    plane.name = "plane";
    append_part(model, generate_mesh(ground), Vec3::Zero(), plane.vertices, plane.faces);
    model.obstacles.push_back(plane);
    const double angle = std::atan(tangent);
    model.gravity = Track<Vec3>(g * Vec3(std::sin(angle), -std::cos(angle), 0));
    model.contact.friction = friction;
    model.hierarchy = {1, 40};
    model.solve.method = Method::direct;
    return model;
}

/// The mean place of the sheet's vertices along the incline, m, in every frame of each level.
struct Path : Recorder {
    void on_hierarchy(const Hierarchy& h) override {
        hierarchy = h;
        of_level.resize(h.levels.size());
    }
    void on_frame(const Frame& frame) override {
        const std::vector<int>& part = hierarchy.levels[static_cast<std::size_t>(frame.level)].part;
        double sum = 0;
        for (std::size_t v = 0; v < part.size(); ++v)
            sum += part[v] == 0 ? (*frame.positions)(0, static_cast<int>(v)) : 0;
        of_level[static_cast<std::size_t>(frame.level)].push_back(
            sum / static_cast<double>(std::count(part.begin(), part.end(), 0)));
    }
    Hierarchy hierarchy;
    std::vector<std::vector<double>> of_level;
};

Path path_of(const Model& model) {
    Path path;
    Context context;
    const RunResult result = run(model, {}, path, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    return path;
}

/// The motion of the last step of a timeline that has become steady, m.
double steady_motion(Model model, double time_step, double friction_velocity) {
    model.solve.time_step = time_step;
    model.solve.duration = 6 * time_step;
    model.solve.frame_interval = time_step;
    model.solve.settle = false;
    model.solve.tolerance = 1e-5 * friction_velocity;
    model.contact.friction_velocity = friction_velocity;
    const std::vector<double> x = path_of(model).of_level.back();
    return x.rbegin()[1] - x.rbegin()[2]; // the frame of the end comes twice
}

/// VALIDATION C2: without inertia a step creeps by y with f1(y) = tan(angle) / mu.
TEST(FrictionOnAnIncline, CreepsInATimelineByWhatBuildsUpTheForce) {
    for (double ratio : {0.1, 0.5, 0.9}) {
        const double h = 0.5, velocity = 1e-5, slip = velocity * h;
        const double creep = steady_motion(incline(0.3, ratio * 0.3), h, velocity);
        EXPECT_NEAR(creep / slip, 1 - std::sqrt(1 - ratio), 0.01 * (1 - std::sqrt(1 - ratio))) << ratio;
    }
}

/// Quasistatic steps have no velocity: what slides moves by h^2 g (sin - mu cos) in each.
TEST(FrictionOnAnIncline, SlidesByTheSameDistanceInEachStep) {
    const double mu = 0.5, h = 0.01;
    for (double degrees : {30.0, 35.0, 45.0}) {
        const double angle = degrees * M_PI / 180;
        const double expected = h * h * g * (std::sin(angle) - mu * std::cos(angle));
        EXPECT_NEAR(steady_motion(incline(mu, std::tan(angle)), h, 1e-4), expected, 0.01 * expected) << degrees;
    }
}

TEST(FrictionOnAnIncline, SticksBelowItsAngleAndSlidesAboveIt) {
    for (double mu : {0.1, 0.3, 0.8}) {
        const double h = 0.01, velocity = 1e-5;
        EXPECT_LT(steady_motion(incline(mu, 0.99 * mu), h, velocity), velocity * h) << mu;
        const double angle = std::atan(1.01 * mu);
        EXPECT_GT(steady_motion(incline(mu, 1.01 * mu), h, velocity),
                  0.9 * h * h * g * (std::sin(angle) - mu * std::cos(angle)))
            << mu;
    }
}

TEST(FrictionOnAnIncline, SettledItStaysWhereItIs) {
    for (int levels : {1, 2}) {
        Model model = incline(0.3, 0.99 * 0.3);
        model.solve.method = levels > 1 ? Method::progressive : Method::direct;
        model.hierarchy.levels = levels;
        model.hierarchy.coarsest_vertices = 8;
        model.solve.time_step = model.solve.duration = model.solve.frame_interval = 0.05;
        const double slip = model.contact.friction_velocity * model.solve.time_step;
        for (const std::vector<double>& x : path_of(model).of_level) { // each settles in several, ever longer steps
            EXPECT_LT(x.back() - x.front(), 2 * slip) << levels;
            EXPECT_GT(x.back() - x.front(), 0.5 * slip) << levels;
        }
    }
}

TEST(Friction, OfOnePairIsItsOwn) {
    Model model = incline(0, 0.3);
    model.contact.pairs = {{0, 1, 0.5}};
    EXPECT_LT(steady_motion(model, 0.01, 1e-4), 1e-6);
    model.contact.friction = 0.5;
    model.contact.pairs = {{1, 0, 0}};
    EXPECT_GT(steady_motion(model, 0.01, 1e-4), 0.9 * 1e-4 * g * std::sin(std::atan(0.3)));
}

TEST(Friction, ResumesToTheSameBitsOnAnyNumberOfThreads) {
    Model model = small_press();
    model.contact.friction = 0.4;
    std::optional<Positions> first;
    int checkpoints = 0;
    for (int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        struct Counter : Recorder {
            void on_checkpoint(const Checkpoint&) override { ++count; }
            int count = 0;
        } counter;
        Context context;
        const Positions end = run(model, {}, counter, context).positions;
        checkpoints = counter.count;
        EXPECT_EQ(first.value_or(end), end);
        first = end;
    }
    struct Cut : Recorder {
        void on_checkpoint(const Checkpoint& checkpoint) override {
            last = checkpoint;
            if (--left == 0)
                context->cancel();
        }
        Context* context = nullptr;
        int left = 0;
        std::optional<Checkpoint> last;
    };
    for (int after : {3, 9, checkpoints / 2, checkpoints - 2}) {
        Cut cut;
        Context context;
        cut.context = &context;
        cut.left = after;
        run(model, {}, cut, context);
        RunOptions options;
        options.resume = &*cut.last;
        Recorder nobody;
        Context again;
        EXPECT_EQ(run(model, options, nobody, again).positions, *first) << after;
    }
}

} // namespace
