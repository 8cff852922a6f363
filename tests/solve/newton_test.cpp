#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <plisse/solve/newton.h>

using namespace plisse;

namespace {

/// Springs of rest length 1 along a chain of points in the plane z = 0, with a wall that x may not pass.
class SpringChain : public Objective {
public:
    explicit SpringChain(int count, double wall = std::numeric_limits<double>::infinity())
        : n_(count), wall_(wall), targets_(VecX::Zero(3 * count)) {
        std::vector<std::uint8_t> prescribed(static_cast<std::size_t>(3 * n_), 0);
        std::fill_n(prescribed.begin(), 3, std::uint8_t{1});
        std::fill_n(prescribed.end() - 3, 3, std::uint8_t{1});
        std::vector<Edge> pairs;
        for (int v = 0; v + 1 < n_; ++v)
            pairs.push_back({v, v + 1});
        system_ = NewtonSystem(prescribed, pairs);
        targets_[3 * (n_ - 1)] = n_ - 1;
    }
    VecX rest() const {
        VecX x = VecX::Zero(3 * n_);
        for (int v = 0; v < n_; ++v)
            x[3 * v] = v;
        return x;
    }
    /// Makes the Hessian this many times stiffer than it is.
    void exaggerate(double factor) { exaggeration_ = factor; }
    void open_wall_after(int steps) { steps_to_opening_ = steps; }
    int assemblies() const { return assemblies_; }
    /// Where the first vertex goes, and the number of its script; the last one's is 0.
    void set_first_target(const Vec3& start, int script) {
        targets_.head<3>() = start;
        script_of_.assign(static_cast<std::size_t>(3 * n_), 0);
        std::fill_n(script_of_.begin(), 3, script);
    }
    void set_target(const Vec3& end) { targets_.tail<3>() = end; }

    double value(const VecX& x) override {
        double sum = 0;
        for (int v = 0; v + 1 < n_; ++v) {
            const double length = (x.segment<3>(3 * v + 3) - x.segment<3>(3 * v)).norm();
            sum += 0.5 * (length - 1) * (length - 1);
        }
        return sum;
    }
    void gradient(const VecX& x, VecX& gradient) override {
        gradient.setZero(x.size());
        for (int v = 0; v + 1 < n_; ++v) {
            const Vec3 edge = x.segment<3>(3 * v + 3) - x.segment<3>(3 * v);
            const Vec3 pull = (1 - 1 / edge.norm()) * edge;
            gradient.segment<3>(3 * v) -= pull;
            gradient.segment<3>(3 * v + 3) += pull;
        }
    }
    void assemble(const VecX& x, NewtonSystem& system, bool /*project*/) override {
        ++assemblies_;
        system.begin({});
        for (int v = 0; v + 1 < n_; ++v) {
            const Vec3 edge = x.segment<3>(3 * v + 3) - x.segment<3>(3 * v);
            const Vec3 n = edge.normalized();
            const Mat3 k =
                n * n.transpose() + std::max(0.0, 1 - 1 / edge.norm()) * (Mat3::Identity() - n * n.transpose());
            const std::array<int, 2> ends = {v, v + 1};
            Eigen::Matrix<double, 6, 6> element;
            element << k, -k, -k, k;
            element += 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
            element *= exaggeration_;
            system.add(ends, element);
        }
    }
    NewtonSystem& system() override { return system_; }
    const VecX& targets() const override { return targets_; }
    const std::vector<int>& script_of() const override { return script_of_; }
    double max_step(const VecX& x, const VecX& d) override {
        double alpha = 1;
        for (int v = 0; v < n_; ++v)
            if (x[3 * v] + d[3 * v] > wall_)
                alpha = std::min(alpha, 0.9 * (wall_ - x[3 * v]) / d[3 * v]);
        return alpha;
    }
    StepLimit step_limit(const VecX& x, const VecX& d) override {
        for (int v = 0; v < n_; ++v)
            if (x[3 * v] + d[3 * v] > wall_)
                return {"wall", "vertex " + std::to_string(v)};
        return {};
    }
    void on_accepted(const VecX& x) override {
        for (int v = 0; v < n_; ++v)
            EXPECT_LE(x[3 * v], wall_);
        if (--steps_to_opening_ == 0)
            wall_ = std::numeric_limits<double>::infinity();
    }

private:
    int n_;
    double wall_;
    double exaggeration_ = 1;
    int assemblies_ = 0, steps_to_opening_ = 0;
    VecX targets_;
    std::vector<int> script_of_;
    NewtonSystem system_;
};

TEST(Newton, FollowsAPrescribedEndAndSharesTheStretch) {
    SpringChain chain(6);
    chain.set_target(Vec3(7.5, 0, 0));
    VecX x = chain.rest();
    LinearSolver solver;
    Context context;
    const NewtonSummary summary = minimize(chain, solver, x, {}, context);
    EXPECT_EQ(summary.end, NewtonEnd::converged) << summary.message;
    EXPECT_EQ(summary.remaining, 0);
    for (int v = 0; v < 6; ++v)
        EXPECT_NEAR(x[3 * v], 1.5 * v, 1e-4);
}

TEST(Newton, LengthensStepsOfAHessianThatIsTooStiff) {
    SpringChain chain(6);
    chain.exaggerate(8);
    chain.set_target(Vec3(5, 0, 0));
    VecX x = chain.rest();
    x[6] += 0.2;
    LinearSolver solver;
    Context context;
    double longest = 0;
    const NewtonSummary summary = minimize(chain, solver, x, {}, context, [&](const NewtonIteration& iteration) {
        longest = std::max(longest, iteration.step_length);
    });
    EXPECT_EQ(summary.end, NewtonEnd::converged) << summary.message;
    EXPECT_GE(longest, 4);
    EXPECT_LE(summary.iterations, 15); // full steps alone would leave 7/8 of the error each time
    for (int v = 0; v < 6; ++v)
        EXPECT_NEAR(x[3 * v], v, 1e-3);
}

TEST(Newton, KeepsItsFactorWhereTheHessianHardlyChanges) {
    SpringChain chain(6);
    chain.set_target(Vec3(7.5, 0, 0));
    VecX x = chain.rest();
    for (int v = 1; v < 5; ++v)
        x[3 * v + 1] = 0.1 * v;
    LinearSolver solver;
    Context context;
    NewtonOptions options;
    options.tolerance = 1e-10;
    const NewtonSummary summary = minimize(chain, solver, x, options, context);
    EXPECT_EQ(summary.end, NewtonEnd::converged) << summary.message;
    EXPECT_LT(chain.assemblies(), summary.iterations); // one each, and one to see the end, without
    for (int v = 0; v < 6; ++v)
        EXPECT_LE((x.segment<3>(3 * v) - Vec3(1.5 * v, 0, 0)).norm(), 1e-9);
}

TEST(Newton, TakesNoStepAtRest) {
    SpringChain chain(4);
    VecX x = chain.rest();
    LinearSolver solver;
    Context context;
    const NewtonSummary summary = minimize(chain, solver, x, {}, context);
    EXPECT_EQ(summary.end, NewtonEnd::converged);
    EXPECT_EQ(summary.iterations, 0);
    EXPECT_EQ(x, chain.rest());
}

TEST(Newton, SaysThatTheScriptIsBlockedAndByWhat) {
    SpringChain chain(4, 3.5);
    chain.set_target(Vec3(5, 0, 0));
    VecX x = chain.rest();
    LinearSolver solver;
    Context context;
    NewtonOptions options;
    options.tolerance = 1e-6;
    std::vector<std::string> causes;
    const NewtonSummary summary = minimize(chain, solver, x, options, context, [&](const NewtonIteration& iteration) {
        if (!iteration.limit.cause.empty())
            causes.push_back(iteration.limit.cause);
    });
    EXPECT_EQ(summary.end, NewtonEnd::blocked);
    EXPECT_GT(summary.remaining, 1.4);
    EXPECT_LT(summary.iterations, 60);
    EXPECT_LE(x[9], 3.5);
    EXPECT_GT(x[9], 3.3);
    for (int v = 1; v < 3; ++v) // the free ones share what has been reached
        EXPECT_NEAR(x[3 * v], v * x[9] / 3, 1e-5);
    EXPECT_NE(summary.message.find("wall: vertex 3"), std::string::npos) << summary.message;
    ASSERT_FALSE(causes.empty());
    EXPECT_LE(causes.size(), 3U); // not once an iteration
    EXPECT_EQ(causes.front(), "wall");
}

TEST(Newton, LetsAScriptArriveThatIsNotInTheWay) {
    SpringChain chain(4, 3.5);
    chain.set_target(Vec3(5, 0, 0));
    chain.set_first_target(Vec3(-1, 0, 0), 1);
    VecX x = chain.rest();
    LinearSolver solver;
    Context context;
    const NewtonSummary summary = minimize(chain, solver, x, {}, context);
    EXPECT_EQ(summary.end, NewtonEnd::blocked) << summary.message;
    EXPECT_EQ(x[0], -1);
    EXPECT_LE(x[9], 3.5);
    EXPECT_LT(summary.iterations, 80);
}

TEST(Newton, GoesOnWithAScriptThatWasHeldUp) {
    SpringChain chain(4, 3.5);
    chain.open_wall_after(12);
    chain.set_target(Vec3(5, 0, 0));
    VecX x = chain.rest();
    LinearSolver solver;
    Context context;
    const NewtonSummary summary = minimize(chain, solver, x, {}, context);
    EXPECT_EQ(summary.end, NewtonEnd::converged) << summary.message;
    EXPECT_EQ(x[9], 5);
}

TEST(Newton, NeverCallsACapConverged) {
    SpringChain chain(6);
    chain.set_target(Vec3(3, 4, 0));
    VecX x = chain.rest();
    LinearSolver solver;
    Context context;
    NewtonOptions options;
    options.max_iterations = 1;
    EXPECT_EQ(minimize(chain, solver, x, options, context).end, NewtonEnd::iteration_cap);
}

TEST(Newton, EndsWhenCancelled) {
    SpringChain chain(6);
    VecX x = chain.rest();
    LinearSolver solver;
    Context context;
    context.cancel();
    EXPECT_EQ(minimize(chain, solver, x, {}, context).end, NewtonEnd::cancelled);
}

} // namespace
