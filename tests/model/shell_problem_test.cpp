#include <gtest/gtest.h>

#include <cmath>

#include <plisse/base/random.h>
#include <plisse/model/shell_problem.h>

#include "drive/small_models.h"

using namespace plisse;

namespace {

/// A curved, pressurised, loaded body near a ball, so that every term of F_l acts.
Model loaded_model(BendingOn bending_on, ProlongationOperator kind, BendingModel bending = BendingModel::hinge) {
    Model model = empty_model("loaded");
    Body& body = add_body(model, "body", {1000, 1e6, 0.3, 2e-3, 1}, sphere_mesh(0.1, 0.03));
    body.pressure = Track<double>(200);
    body.material.bending = bending;
    Obstacle ball;
    ball.name = "ball";
    append_part(model, sphere_mesh(0.1, 0.04), Vec3(0, -0.205, 0), ball.vertices, ball.faces);
    model.obstacles.push_back(ball);
    model.loads.push_back({Load::Kind::force, 0, {0, 1, 2}, Track<Vec3>(Vec3(0.1, 0.2, -0.3))});
    model.pulls.push_back(
        {"pull", 0, 300, {{5, Track<Vec3>(Vec3(0.1, 0.1, 0))}, {40, Track<Vec3>(Vec3(0, 0.1, 0.1))}}});
    model.contact.distance = 8e-3;
    model.hierarchy = {3, 60, kind, bending_on};
    return model;
}

class ProxyDerivatives : public testing::TestWithParam<std::tuple<int, BendingOn, ProlongationOperator, BendingModel>> {
};

TEST_P(ProxyDerivatives, GradientMatchesCentralDifferences) {
    const auto [level, bending_on, kind, bending] = GetParam();
    Context context;
    const Model model = loaded_model(bending_on, kind, bending);
    const Discretization discretization(model, 3, context);
    ShellProblem problem(discretization, level, EnergiesOf::finest, context);
    Random random(3);
    Positions start = discretization.start(level);
    const Positions anchor = start;
    problem.begin_step(start, anchor, 0, 0.1);
    VecX x = as_vector(start);
    for (Eigen::Index i = 0; i < x.size(); ++i)
        if (!problem.system().prescribed()[static_cast<std::size_t>(i)])
            x[i] += random.uniform(-1e-3, 1e-3) - (i % 3 == 1 ? 3.5e-3 : 0); // down, into contact
    ASSERT_TRUE(std::isfinite(problem.value(x)));
    if (level == discretization.finest()) {
        EXPECT_GT(problem.active_contacts(x), 0);
    }
    VecX gradient;
    problem.gradient(x, gradient);
    for (int direction = 0; direction < 20; ++direction) {
        VecX d(x.size());
        for (double& entry : d)
            entry = random.uniform(-1, 1);
        const double h = 1e-7;
        const double difference = (problem.value(x + h * d) - problem.value(x - h * d)) / (2 * h);
        EXPECT_NEAR(difference, gradient.dot(d), 1e-6 * gradient.norm() * d.norm());
    }
}

INSTANTIATE_TEST_SUITE_P(Levels, ProxyDerivatives,
                         testing::Combine(testing::Values(0, 1, 2),
                                          testing::Values(BendingOn::finest, BendingOn::level),
                                          testing::Values(ProlongationOperator::shell, ProlongationOperator::intrinsic,
                                                          ProlongationOperator::blend, ProlongationOperator::affine),
                                          testing::Values(BendingModel::hinge, BendingModel::koiter)));

/// The limit acts on the level's own faces, whatever carries the elasticity.
TEST(ShellProblem, FeelsStrainLimitsOnEveryLevel) {
    for (BendingOn bending_on : {BendingOn::finest, BendingOn::level}) {
        Model model = loaded_model(bending_on, ProlongationOperator::shell);
        model.bodies[0].material.strain_limit = 1.3;
        Context context;
        const Discretization discretization(model, 3, context);
        for (int level = 0; level < 3; ++level) {
            ShellProblem problem(discretization, level, EnergiesOf::finest, context);
            const Positions start = discretization.start(level);
            problem.begin_step(start, start, 0, 0.1);
            Random random(3);
            VecX x = as_vector(start);
            for (Eigen::Index i = 0; i < x.size(); ++i)
                if (!problem.system().prescribed()[static_cast<std::size_t>(i)])
                    x[i] = 1.2 * x[i] + random.uniform(-5e-4, 5e-4) + (i % 3 == 1 ? 0.03 : 0);
            EXPECT_GT(problem.energies(x).strain_limit, 0);
            EXPECT_GT(problem.forces(x).strain_limit.cwiseAbs().maxCoeff(), 0);
            VecX gradient;
            problem.gradient(x, gradient);
            for (int direction = 0; direction < 5; ++direction) {
                const VecX d = VecX::NullaryExpr(x.size(), [&] { return random.uniform(-1, 1); });
                const double h = 1e-7;
                const double difference = (problem.value(x + h * d) - problem.value(x - h * d)) / (2 * h);
                EXPECT_NEAR(difference, gradient.dot(d), 1e-6 * gradient.norm() * d.norm());
            }
            const VecX away = 10 * (x - as_vector(start));
            const double step = problem.max_step(x, away);
            EXPECT_GT(step, 0);
            EXPECT_LT(problem.max_stretch(x + step * away), 1.3);
            EXPECT_GT(problem.max_stretch(x + 2 * step * away), 1.3);
        }
    }
}

TEST(ShellProblem, RecoversRestAndFeelsNothingThereOnEveryLevel) {
    Context context;
    Model model = loaded_model(BendingOn::finest, ProlongationOperator::shell);
    model.bodies[0].pressure = Track<double>(0);
    model.loads.clear();
    model.pulls.clear();
    model.gravity = Track<Vec3>(Vec3::Zero());
    const Discretization discretization(model, 3, context);
    const double scale = model.bodies[0].material.youngs_modulus * model.bodies[0].material.thickness * 0.1;
    for (int level = 0; level < 3; ++level) {
        ShellProblem problem(discretization, level, EnergiesOf::finest, context);
        const Positions start = discretization.start(level);
        problem.begin_step(start, start, 0, 0.1);
        const VecX x = as_vector(start);
        EXPECT_LT((problem.carried(x).leftCols(model.bodies[0].vertices.end) -
                   model.mesh.positions.leftCols(model.bodies[0].vertices.end))
                      .cwiseAbs()
                      .maxCoeff(),
                  1e-10 * 0.35);
        VecX gradient;
        problem.gradient(x, gradient);
        EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 1e-11 * scale);
        EXPECT_EQ(problem.active_contacts(x), 0);
        EXPECT_EQ(problem.residual(x), 0);
    }
}

TEST(ShellProblem, SharesTheMassOutOverEveryLevel) {
    Context context;
    const Model model = loaded_model(BendingOn::finest, ProlongationOperator::shell);
    const Discretization discretization(model, 3, context);
    Vec3 weight = Vec3::Zero();
    for (int level = 0; level < 3; ++level) {
        ShellProblem problem(discretization, level, EnergiesOf::finest, context);
        const Positions start = discretization.start(level);
        problem.begin_step(start, start, 0, 0.1);
        const Vec3 total = problem.forces(as_vector(start)).gravity.rowwise().sum();
        if (level == 0)
            weight = total;
        EXPECT_LT(total.y(), 0);
        EXPECT_NEAR(total.y(), weight.y(), 1e-12);
    }
}

TEST(ShellProblem, SaysWhatLimitsAStep) {
    Context context;
    const Model model = loaded_model(BendingOn::finest, ProlongationOperator::shell);
    const Discretization discretization(model, 3, context);
    for (int level : {0, 2}) {
        ShellProblem problem(discretization, level, EnergiesOf::finest, context);
        const Positions start = discretization.start(level);
        problem.begin_step(start, start, 0, 0.1);
        VecX fall = VecX::Zero(start.size());
        for (int v = 0; v < start.cols(); ++v)
            if (discretization.mesh(level).part[static_cast<std::size_t>(v)] == 0)
                fall[3 * v + 1] = -0.05;
        EXPECT_LT(problem.max_step(as_vector(start), fall), 1);
        const StepLimit limit = problem.step_limit(as_vector(start), fall);
        EXPECT_EQ(limit.cause, "contact");
        for (const char* part : {" of body", " of ball", " m apart at ("})
            EXPECT_NE(limit.detail.find(part), std::string::npos) << limit.detail;
        EXPECT_EQ(problem.step_limit(as_vector(start), 1e-3 * fall).cause, "");
    }
}

TEST(ShellProblem, FindsTheTightestPairThatCanMove) {
    Model model = empty_model("sheet above a floor");
    add_body(model, "sheet", {}, sheet_mesh(0.2, 0.1), Vec3(0, 0.01, 0));
    const int count = model.mesh.vertex_count();
    Obstacle floor;
    floor.name = "floor";
    append_part(model, sheet_mesh(0.4, 0.1), Vec3::Zero(), floor.vertices, floor.faces);
    model.obstacles.push_back(floor);
    model.contact.distance = 4e-3;
    model.contact.thickness = 1e-3;
    Positions x = model.start;
    x.row(1).head(count).setConstant(3e-3);
    const auto tightest_pair = [&](const Positions& points) {
        Context context;
        const Discretization discretization(model, 1, context);
        return ShellProblem(discretization, 0, EnergiesOf::level, context).tightest_pair(as_vector(points));
    };
    EXPECT_EQ(tightest_pair(model.start).share, 1);
    const TightestPair tightest = tightest_pair(x);
    EXPECT_NEAR(tightest.gap, 2e-3, 1e-15);
    EXPECT_NEAR(tightest.share, 0.5, 1e-12);
    for (const char* part : {" of sheet", " of floor", " 0.003 m apart at ("})
        EXPECT_NE(tightest.words.find(part), std::string::npos) << tightest.words;
    Handle all;
    all.name = "all";
    for (int v = 0; v < count; ++v)
        all.vertices.push_back(v);
    model.handles.push_back(all);
    EXPECT_EQ(tightest_pair(x).share, 1) << "no force moves it";
    EXPECT_EQ(tightest_pair(x).words, "");
}

TEST(ShellProblem, SaysWhichTriangleWouldCollapse) {
    Model model = empty_model("sheet");
    add_body(model, "sheet", {}, sheet_mesh(0.1, 0.03));
    model.contact.self = false;
    Context context;
    const Discretization discretization(model, 1, context);
    ShellProblem problem(discretization, 0, EnergiesOf::level, context);
    const Positions start = discretization.start(0);
    problem.begin_step(start, start, 0, 0.1);
    const Face face = discretization.mesh(0).faces[5];
    VecX flattening = VecX::Zero(start.size());
    flattening.segment<3>(3 * face[0]) = 0.5 * (start.col(face[1]) + start.col(face[2])) - start.col(face[0]);
    EXPECT_LT(problem.max_step(as_vector(start), flattening), 0.91);
    const StepLimit limit = problem.step_limit(as_vector(start), flattening);
    EXPECT_EQ(limit.cause, "triangle");
    EXPECT_NE(limit.detail.find(" of sheet would collapse"), std::string::npos) << limit.detail;
}

} // namespace
