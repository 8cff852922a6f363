#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include <plisse/base/parallel.h>
#include <plisse/solve/trust_region.h>

#include "linalg/dense_system.h"
#include "solve/spline_net.h"

using namespace plisse;

namespace {

VecX at(double x, double y, double z) {
    VecX point(3);
    point << x, y, z;
    return point;
}

/// 100 (y - x^2)^2 + (1 - x)^2 + (z - y)^4 of one vertex: curved valley, indefinite between its walls.
class Valley : public Objective {
public:
    Valley() : system_(std::vector<std::uint8_t>(3, 0), {}) {}
    double value(const VecX& p) override {
        if (p[0] > wall)
            return std::numeric_limits<double>::infinity();
        const double a = p[1] - p[0] * p[0], b = 1 - p[0], c = p[2] - p[1];
        return 100 * a * a + b * b + c * c * c * c + offset;
    }
    void gradient(const VecX& p, VecX& gradient) override {
        const double a = p[1] - p[0] * p[0], b = 1 - p[0], c = p[2] - p[1];
        gradient.resize(3);
        gradient << -400 * a * p[0] - 2 * b, 200 * a - 4 * c * c * c, 4 * c * c * c;
    }
    void assemble(const VecX& p, NewtonSystem& system, bool /*project*/) override {
        ++assembled;
        const double a = p[1] - p[0] * p[0], c = 12 * (p[2] - p[1]) * (p[2] - p[1]);
        Mat3 h;
        h << 800 * p[0] * p[0] - 400 * a + 2, -400 * p[0], 0, -400 * p[0], 200 + c, -c, 0, -c, c;
        system.begin({});
        system.add_block(0, 0, h);
    }
    NewtonSystem& system() override { return system_; }
    const VecX& targets() const override { return targets_; }
    double max_step(const VecX&, const VecX& d) override { return std::min(1.0, longest / d.norm()); }

    double wall = std::numeric_limits<double>::infinity(), longest = std::numeric_limits<double>::infinity();
    double offset = 0;
    int assembled = 0;

private:
    VecX targets_;
    NewtonSystem system_;
};

std::vector<QuadraticOptions> methods() {
    QuadraticOptions dogleg, exact, cg, jacobi;
    dogleg.method = QuadraticMethod::dogleg;
    cg.method = jacobi.method = QuadraticMethod::conjugate_gradients;
    cg.max_iterations = jacobi.max_iterations = 500;
    jacobi.preconditioning = Preconditioning::block_jacobi;
    jacobi.norm = RadiusNorm::preconditioner;
    return {dogleg, exact, cg, jacobi};
}

TEST(SplineNet, HasTheDerivativesOfItsValue) {
    NetLaw law;
    law.approach = 0.1;
    SplineNet net(4, law);
    const VecX x = net.start(0.3) + 0.02 * random_vector(147, 1);
    const VecX d = random_vector(147, 2);
    const double h = 1e-5;
    VecX gradient, ahead, behind;
    net.gradient(x, gradient);
    EXPECT_NEAR((net.value(x + h * d) - net.value(x - h * d)) / (2 * h), gradient.dot(d), 1e-6 * gradient.norm());
    net.assemble(x, net.system(), false);
    net.gradient(x + h * d, ahead);
    net.gradient(x - h * d, behind);
    const VecX product = dense(net.system()) * d;
    EXPECT_LT(((ahead - behind) / (2 * h) - product).norm(), 1e-6 * product.norm());
}

TEST(TrustRegion, FollowsACurvedValley) {
    for (const QuadraticOptions& method : methods()) {
        Valley valley;
        VecX x = at(-1.2, 1, 2);
        TrustRegionOptions options;
        options.quadratic = method;
        options.stop.gradient = 1e-11;
        Context context;
        double last = valley.value(x);
        int accepted = 0;
        const TrustRegionSummary summary =
            minimize_by_trust_region(valley, x, options, context, [&](const TrustRegionIteration& iteration) {
                EXPECT_LE(iteration.value, last + 1e-15);
                EXPECT_LE(iteration.trial.norm, iteration.trial.radius * (1 + 1e-9));
                last = iteration.value;
                accepted += iteration.trial.accepted;
            });
        EXPECT_TRUE(summary.converged()) << summary.message;
        EXPECT_LT((x - Vec3(1, 1, 1)).head<2>().norm(), 1e-8);
        EXPECT_NEAR(x[2], 1, 1e-3); // the quartic's gradient vanishes long before
        EXPECT_LE(summary.iterations, 100);
        EXPECT_EQ(summary.accepted, accepted);
        EXPECT_EQ(summary.assemblies, valley.assembled);
        EXPECT_LE(summary.assemblies, accepted + 1); // none after a rejection
    }
}

TEST(TrustRegion, InterpolatesTheRadiusAfterARejection) {
    const TrustRegionConstants constants = interpolating_constants();
    TrustRegionConstants halving = constants;
    halving.least_gamma = halving.gamma1;
    TrialStep trial;
    trial.norm = 2;
    trial.ratio = -1;
    trial.slope = -4; // of f = -4 t + 10 t^2 at the step's end, t = 1; the minimum is at t = 1/5
    trial.actual = -6;
    EXPECT_DOUBLE_EQ(next_radius(constants, 3, trial), 0.2 * 2);
    EXPECT_EQ(next_radius(halving, 3, trial), 1);
    trial.actual = -1e9;
    EXPECT_EQ(next_radius(constants, 3, trial), 2.0 / 16);
    trial.actual = -std::numeric_limits<double>::infinity();
    EXPECT_EQ(next_radius(constants, 3, trial), 2.0 / 16);
    trial.actual = 0.1; // a decrease, but too little of one
    trial.slope = -1;
    EXPECT_EQ(next_radius(constants, 3, trial), 1);
    trial.slope = 0; // unknown
    EXPECT_EQ(next_radius(constants, 3, trial), 1);
}

TEST(TrustRegion, TakesAnInfiniteValueForARejection) {
    Valley valley;
    valley.wall = 0.5;
    VecX x = at(-1.2, 1, 2);
    TrustRegionOptions options;
    options.radius = 100;
    Context context;
    const TrustRegionSummary summary = minimize_by_trust_region(valley, x, options, context);
    EXPECT_FALSE(summary.converged()) << summary.message; // the infimum lies on the wall
    EXPECT_LE(x[0], 0.5);
    EXPECT_NEAR(x[0], 0.5, 1e-3);
    x = at(0.6, 0, 0);
    EXPECT_EQ(minimize_by_trust_region(valley, x, options, context).end, TrustRegionEnd::infeasible);
}

TEST(TrustRegion, KeepsToTheLargestSafeStep) {
    Valley valley;
    valley.longest = 0.05;
    VecX x = at(-1.2, 1, 1);
    Context context;
    const TrustRegionSummary summary =
        minimize_by_trust_region(valley, x, {}, context, [&](const TrustRegionIteration& iteration) {
            EXPECT_LE(iteration.trial.length, 0.05 * (1 + 1e-12));
        });
    EXPECT_TRUE(summary.converged()) << summary.message;
    EXPECT_GE(summary.iterations, 40); // the way is over two units long
    EXPECT_LT((x - Vec3(1, 1, 1)).norm(), 1e-3);
    valley.longest = 0; // nothing may move: no convergence to tell of
    x = at(-1.2, 1, 1);
    EXPECT_FALSE(minimize_by_trust_region(valley, x, {}, context).converged());
}

TEST(TrustRegion, EndsHonestly) {
    Valley valley;
    Context context;
    TrustRegionOptions options;
    options.stop.max_iterations = 3;
    VecX x = at(-1.2, 1, 2);
    EXPECT_EQ(minimize_by_trust_region(valley, x, options, context).end, TrustRegionEnd::iteration_cap);

    options = {};
    options.stop.gradient = 0; // never
    valley.offset = 1e3;       // hides the last digits
    x = at(-1.2, 1, 1);
    TrustRegionSummary summary = minimize_by_trust_region(valley, x, options, context);
    EXPECT_EQ(summary.end, TrustRegionEnd::rounding) << summary.message;
    EXPECT_LT((x - Vec3(1, 1, 1)).norm(), 2e-3);

    options.stop.noisy_steps = 0;
    x = at(-1.2, 1, 1);
    summary = minimize_by_trust_region(valley, x, options, context);
    EXPECT_EQ(summary.end, TrustRegionEnd::small_change) << summary.message;
    EXPECT_GT(summary.radius, 1e15);

    context.cancel();
    x = at(-1.2, 1, 2);
    summary = minimize_by_trust_region(valley, x, options, context);
    EXPECT_EQ(summary.end, TrustRegionEnd::interrupted);
    EXPECT_EQ(summary.iterations, 0);
}

TEST(TrustRegion, MinimizesABucklingNetByEveryMethod) {
    NetLaw law;
    law.approach = 0.1;
    NetHierarchy hierarchy(4, 2, law);
    std::vector<double> values;
    std::vector<QuadraticOptions> all = methods();
    all[2].max_iterations = all[3].max_iterations = 2000;
    all.push_back(all[3]);
    all.back().preconditioning = Preconditioning::multigrid;
    for (const QuadraticOptions& method : all) {
        VecX x = hierarchy.finest().start(-0.1);
        TrustRegionOptions options;
        options.quadratic = method;
        Context context;
        const TrustRegionSummary summary =
            minimize_by_trust_region(hierarchy.finest(), x, options, context, {}, hierarchy.prolongations);
        EXPECT_TRUE(summary.converged()) << summary.message;
        EXPECT_LE(summary.iterations, 60);
        EXPECT_NEAR(summary.value, values.empty() ? summary.value : values.front(), 1e-8 * std::abs(summary.value));
        values.push_back(summary.value);
    }
}

} // namespace
