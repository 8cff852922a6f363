#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <plisse/base/error.h>
#include <plisse/base/random.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/model/shell_problem.h>

#include "drive/small_models.h"

using namespace plisse;

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// A ball that stands on a plate, its cap turned by one handle, of which a part is held along y by another too.
Model turned_ball() {
    Model model = empty_model("turned ball");
    const TriangleMesh ball = sphere_mesh(0.1, 0.06);
    const Body& body = add_body(model, "ball", {1000, 1e6, 0.3, 2e-3, 1}, ball);
    Handle cap, height;
    cap.name = "cap";
    cap.axes = {true, false, true};
    cap.motion.rotate_deg.keys = {{0, Vec3::Zero()}, {1, Vec3(0, 50, 0)}};
    height.name = "height";
    height.axes = {false, true, false};
    for (int v = 0; v < body.vertices.end; ++v) {
        if (ball.positions(1, v) > 0.03)
            cap.vertices.push_back(v);
        if (ball.positions(1, v) > 0.03 && ball.positions(0, v) > 0)
            height.vertices.push_back(v);
    }
    model.handles = {cap, height};
    Load push;
    push.kind = Load::Kind::traction;
    for (int v = 0; v < body.vertices.end; ++v)
        if (ball.positions(1, v) < 0)
            push.vertices.push_back(v);
    push.value = Track<Vec3>(Vec3(0, 5, 0));
    model.loads.push_back(push);
    Obstacle plate;
    plate.name = "plate";
    plate.motion.translate.keys = {{0, Vec3(0, -0.2, 0)}, {1, Vec3(0, -0.15, 0)}};
    append_part(model, sheet_mesh(0.3, 0.1), Vec3::Zero(), plate.vertices, plate.faces);
    model.obstacles.push_back(plate);
    model.hierarchy.levels = 3;
    model.hierarchy.source = HierarchySource::loop;
    model.hierarchy.prolongation = ProlongationOperator::loop;
    return model;
}

class SubdividedModel : public testing::Test {
protected:
    Context context;
    const Model model = turned_ball();
    const Discretization discretization{model, 3, context};
    const Model& finest = discretization.model();
};

TEST_F(SubdividedModel, HasItsPartsOnTheFinestLevel) {
    const int plate = model.obstacles[0].vertices.size();
    EXPECT_EQ(discretization.hierarchy().levels[0].rest.cols(), model.mesh.vertex_count());
    EXPECT_EQ(finest.bodies[0].faces.size(), 16 * model.bodies[0].faces.size());
    EXPECT_EQ(finest.obstacles[0].vertices.size(), plate);
    EXPECT_EQ(finest.obstacles[0].vertices.end, finest.mesh.vertex_count());
    EXPECT_EQ(finest.vertex_parts(), discretization.hierarchy().finest().part);
    EXPECT_EQ(finest.mesh.positions.rightCols(plate), model.mesh.positions.rightCols(plate)) << "before its motion";
    const Positions posed = model.mesh.positions.rightCols(plate).colwise() + Vec3(0, -0.2, 0);
    for (int level = 0; level < 3; ++level)
        EXPECT_LT((discretization.start(level).rightCols(plate) - posed).cwiseAbs().maxCoeff(), 1e-16);
}

TEST_F(SubdividedModel, PrescribesTheSameMotionOnEveryLevel) {
    for (ProlongationOperator kind : {ProlongationOperator::loop, ProlongationOperator::intrinsic})
        for (int level = 0; level < 2; ++level) {
            const Positions moved =
                prolongation_to_next(discretization.hierarchy(), level, kind).apply(discretization.script(level, 0.7));
            const Positions script = discretization.script(level + 1, 0.7);
            const auto& prescribed = discretization.layout(level + 1).prescribed;
            int count = 0;
            for (int v = 0; v < discretization.hierarchy().levels[at(level + 1)].rest.cols(); ++v)
                for (int axis = 0; axis < 3; ++axis)
                    if (prescribed[at(3 * v + axis)]) {
                        EXPECT_NEAR(moved(axis, v), script(axis, v), 1e-15);
                        ++count;
                    }
            EXPECT_GT(count, 100);
        }
}

TEST_F(SubdividedModel, KeepsPinnedVerticesToTheBit) {
    const HierarchyLevel& coarsest = discretization.mesh(0);
    for (const Handle& handle : model.handles)
        for (int v : handle.vertices)
            for (int level = 1; level < 3; ++level) {
                const auto& ids = discretization.mesh(level).vertex_ids;
                const auto found = std::lower_bound(ids.begin(), ids.end(), coarsest.vertex_ids[at(v)]);
                EXPECT_EQ(discretization.mesh(level).rest.col(found - ids.begin()), model.mesh.positions.col(v));
            }
}

TEST_F(SubdividedModel, HandlesAndLoadsTakeWhatLiesBetweenTheirVertices) {
    for (int number : {0, 1}) {
        const Handle &coarse = model.handles[at(number)], &fine = finest.handles[at(number)];
        std::vector<bool> inside(at(model.mesh.vertex_count()), false);
        for (int v : coarse.vertices)
            inside[at(v)] = true;
        const HierarchyLevel& coarsest = discretization.mesh(0);
        std::vector<int> expected;
        for (std::size_t v = 0; v < coarsest.to_finest.size(); ++v) {
            bool all = true;
            for (int k = 0; k < 3; ++k) {
                const Anchor& anchor = coarsest.to_finest[v];
                all = all && (anchor.weights[k] == 0 || inside[at(coarsest.faces[at(anchor.face)][at(k)])]);
            }
            if (all)
                expected.push_back(static_cast<int>(v));
        }
        EXPECT_EQ(fine.vertices, expected);
        EXPECT_GT(expected.size(), 5 * coarse.vertices.size());
        for (int v : expected) {
            const auto& handles = discretization.handles_of(2, v);
            EXPECT_NE(std::find(handles.begin(), handles.end(), number), handles.end());
        }
    }
    EXPECT_GT(finest.loads[0].vertices.size(), 10 * model.loads[0].vertices.size());
    for (int v : finest.loads[0].vertices)
        EXPECT_LT(finest.mesh.positions(1, v), 1e-12);
}

TEST_F(SubdividedModel, GradientMatchesCentralDifferences) {
    for (int level = 0; level < 3; ++level) {
        ShellProblem problem(discretization, level, EnergiesOf::finest, context);
        const Positions start = discretization.start(level);
        problem.begin_step(start, start, 0, 0.1);
        Random random(3);
        VecX x = as_vector(start);
        for (Eigen::Index i = 0; i < x.size(); ++i)
            x[i] += random.uniform(-1e-3, 1e-3);
        VecX gradient;
        problem.gradient(x, gradient);
        for (int direction = 0; direction < 5; ++direction) {
            const VecX d = VecX::NullaryExpr(x.size(), [&] { return random.uniform(-1, 1); });
            const double h = 1e-7;
            const double difference = (problem.value(x + h * d) - problem.value(x - h * d)) / (2 * h);
            EXPECT_NEAR(difference, gradient.dot(d), 1e-6 * gradient.norm() * d.norm()) << level;
        }
    }
}

TEST(SubdividedStart, FollowsTheRuleOfTheRestShape) {
    Model model = turned_ball();
    model.handles.clear();
    const int of_ball = model.bodies[0].vertices.end;
    const Vec3 shift(0.01, 0.3, 0);
    for (int v = 0; v < of_ball; ++v)
        model.start.col(v) = 1.25 * model.mesh.positions.col(v) + shift;
    Context context;
    const Discretization discretization(model, 3, context);
    for (int level = 0; level < 3; ++level) {
        const Positions& rest = discretization.mesh(level).rest;
        const int count = static_cast<int>(rest.cols()) - model.obstacles[0].vertices.size();
        const Positions expected = (1.25 * rest.leftCols(count)).colwise() + shift;
        EXPECT_LT((discretization.start(level).leftCols(count) - expected).cwiseAbs().maxCoeff(), 1e-15);
    }
    EXPECT_EQ(discretization.start(0).leftCols(of_ball), model.start.leftCols(of_ball));
}

TEST(SubdividedModelErrors, SayWhereAFinerLevelMeetsItself) {
    // A coarse ball around a finer one: smoothed, it shrinks into it.
    Model model = empty_model("nested");
    add_body(model, "outer", {}, sphere_mesh(0.1, 0.09));
    Obstacle inner;
    inner.name = "inner";
    append_part(model, sphere_mesh(0.076, 0.01), Vec3::Zero(), inner.vertices, inner.faces);
    model.obstacles.push_back(inner);
    model.hierarchy.source = HierarchySource::loop;
    Context context;
    EXPECT_NO_THROW(Discretization(model, 1, context));
    try {
        Discretization discretization(model, 2, context);
        FAIL() << "the levels intersect";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("level 1, subdivided, intersects itself at rest near ("),
                  std::string::npos)
            << error.what();
    }
}

} // namespace
