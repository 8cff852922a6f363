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

/// A flat body `height` above flat ground, as on an incline whose tangent is given: gravity leans to +x.
Model incline(double friction, double tangent, const TriangleMesh& body, const Material& material,
              const TriangleMesh& ground, double height) {
    Model model = empty_model("incline");
    add_body(model, "sheet", material, body, Vec3(0.02, height, -0.03));
    Obstacle plane;
    plane.name = "plane";
    append_part(model, ground, Vec3::Zero(), plane.vertices, plane.faces);
    model.obstacles.push_back(plane);
    const double angle = std::atan(tangent);
    model.gravity = Track<Vec3>(g * Vec3(std::sin(angle), -std::cos(angle), 0));
    model.contact.friction = friction;
    model.hierarchy = {1, 40};
    model.solve.method = Method::direct;
    return model;
}

const Material rubber{1000, 1e7, 0.3, 1e-3, 1};

/// A sheet above one large triangle.
Model incline(double friction, double tangent) {
    TriangleMesh ground;
    ground.positions.resize(3, 3);
    ground.positions << -40, 0, 40, 0, 0, 0, -40, 40, -40;
    ground.faces = {{0, 1, 2}};
    return incline(friction, tangent, sheet_mesh(0.1, 0.03), rubber, ground, 0.998e-3);
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

/// How far the body slides in the last step, as a share of what it would without friction.
double share_slid(const Model& model) {
    const double h = 0.01, whole = h * h * model.gravity.at(0).x();
    return steady_motion(model, h, 1e-5) / whole;
}

/// A sheet, and a plate: a closed box so stiff that it hardly bends. Ground of large and small triangles, and starts
/// within the contact distance and well above it.
TEST(FrictionOnAnIncline, SwitchesWithinAPercentHoweverTheGroundIsTriangulated) {
    GeneratorOptions box;
    box.shape = GeneratorShape::box;
    box.size = Vec3(0.1, 0.02, 0.08);
    box.edge_length = 0.02;
    TriangleMesh plate = generate_mesh(box);
    plate.positions.row(1).array() += 0.01; // stands on its lower face
    const Material metal{2700, 7e9, 0.3, 2e-3, 1};
    for (const double mu : {0.1, 0.3, 0.8})
        for (const double edge_length : {0.1, 0.025})
            for (const double height : {0.6e-3, 2.2e-3})
                for (const bool is_plate : {false, true}) {
                    SCOPED_TRACE(testing::Message() << mu << ' ' << edge_length << ' ' << height << ' ' << is_plate);
                    const auto model = [&](double ratio) {
                        return is_plate ? incline(mu, ratio * mu, plate, metal, sheet_mesh(0.6, edge_length), height)
                                        : incline(mu, ratio * mu, sheet_mesh(0.1, 0.02), rubber,
                                                  sheet_mesh(0.6, edge_length), height);
                    };
                    EXPECT_LT(share_slid(model(0.99)), 1e-3);
                    EXPECT_NEAR(share_slid(model(1.01)), 1 - 1 / 1.01, 5e-3); // of the weight's pull, mu holds the rest
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

/// A belt around half of a cylinder, from one end of which a weight hangs.
struct Belt {
    static constexpr double radius = 0.05, width = 0.01, straight = 0.02, gap = 2.5e-4;
    static constexpr int around = 60;

    /// A place on the belt, `along` from the middle of its way around the cylinder.
    static Vec3 place(double along, double across) {
        const double r = radius + gap, angle = std::clamp(along / r, -0.5 * M_PI, 0.5 * M_PI);
        const double down = std::max(0.0, std::abs(along) - 0.5 * M_PI * r);
        return {r * std::sin(angle), r * std::cos(angle) - down, across};
    }

    static TriangleMesh mesh() {
        GeneratorOptions strip;
        strip.shape = GeneratorShape::sheet;
        strip.pattern = Pattern::regular;
        const double length = M_PI * (radius + gap) + 2 * straight;
        strip.size = Vec3(length, width, 0);
        strip.cells = {static_cast<int>(std::lround(around * length / (M_PI * radius))), 2};
        TriangleMesh belt = generate_mesh(strip);
        for (int v = 0; v < belt.vertex_count(); ++v)
            belt.positions.col(v) = place(belt.positions(0, v), belt.positions(2, v));
        return belt;
    }

    static TriangleMesh cylinder() {
        GeneratorOptions options;
        options.shape = GeneratorShape::cylinder;
        options.radius = radius;
        options.height = 2 * width;
        options.edge_length = M_PI * radius / around;
        TriangleMesh cylinder = generate_mesh(options);
        cylinder.positions.row(1).swap(cylinder.positions.row(2)); // its axis to z: what turns its faces over is no
                                                                   // matter to an obstacle
        return cylinder;
    }

    Belt(double friction, double tension) : model(empty_model("belt")) {
        add_body(model, "belt", {1000, 1e9, 0, 2e-4, 1}, mesh());
        Obstacle drum;
        drum.name = "drum";
        append_part(model, cylinder(), Vec3::Zero(), drum.vertices, drum.faces);
        model.obstacles.push_back(drum);
        hang(-1, tension);
        model.gravity = Track<Vec3>(Vec3::Zero());
        model.contact.distance = 1e-4;
        model.contact.friction = friction;
        model.contact.friction_velocity = 1e-5;
        model.hierarchy.levels = 1;
        model.solve.method = Method::direct;
        model.solve.time_step = model.solve.frame_interval = 1;
        model.solve.duration = 4;
        model.solve.settle = false;
        model.solve.tolerance = 1e-8;
    }
    /// Vertices of the end at x < 0 or x > 0.
    std::vector<int> end(int side) const {
        std::vector<int> vertices;
        for (int v = 0; v < model.bodies[0].vertices.end; ++v)
            if (model.mesh.positions(1, v) < -0.999 * straight && side * model.mesh.positions(0, v) > 0)
                vertices.push_back(v);
        return vertices;
    }
    void hang(int side, double weight) {
        Load load;
        load.vertices = end(side);
        load.value = Track<Vec3>(Vec3(0, -weight, 0));
        model.loads.push_back(load);
    }
    void draw(int side, double way) {
        Handle handle;
        handle.name = "drawn";
        handle.vertices = end(side);
        handle.motion.translate.keys = {{0, Vec3::Zero()}, {model.solve.duration, Vec3(0, -way, 0)}};
        model.handles.push_back(handle);
    }
    Model model;
};

TEST(Belt, MultipliesItsTensionByTheExponentialOfItsAngle) {
    for (const double mu : {0.1, 0.3, 0.5}) {
        constexpr double tension = 0.5;
        Belt belt(mu, tension);
        belt.draw(1, 0.002);
        Recorder nobody;
        Context context;
        const RunResult result = run(belt.model, {}, nobody, context);
        ASSERT_EQ(result.report.status, RunStatus::converged) << result.report.message;
        const double drawn = result.report.reactions.front().force.norm();
        EXPECT_NEAR(drawn / tension, std::exp(mu * M_PI), 0.01 * std::exp(mu * M_PI)) << mu;
    }
}

TEST(Belt, HoldsUpToThatRatioAndSlipsBeyond) {
    constexpr double mu = 0.3, tension = 0.5, step = 1e-3, slip = 1e-5 * step;
    const auto last_step = [&](double ratio) {
        Belt belt(mu, tension);
        belt.hang(1, ratio * std::exp(mu * M_PI) * tension);
        belt.model.solve.time_step = belt.model.solve.frame_interval = step;
        belt.model.solve.duration = 10 * step;
        const std::vector<double> x = path_of(belt.model).of_level.back();
        return x.rbegin()[1] - x.rbegin()[2];
    };
    EXPECT_LT(last_step(0.97), slip);
    EXPECT_GT(last_step(1.03), 100 * slip);
}

} // namespace
