#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <plisse/base/parallel.h>
#include <plisse/solve/rmtr.h>

#include "solve/spline_net.h"

using namespace plisse;

namespace {

NetLaw buckling() {
    NetLaw law;
    law.approach = 0.1;
    return law;
}

double reference_value(NetHierarchy& hierarchy, VecX x) {
    Context context;
    const TrustRegionSummary summary = minimize_by_trust_region(hierarchy.finest(), x, {}, context);
    EXPECT_TRUE(summary.converged()) << summary.message;
    return summary.value;
}

QuadraticOptions smoothing(Preconditioning preconditioning) {
    QuadraticOptions options = smoothing_by_block_jacobi();
    options.preconditioning = preconditioning;
    return options;
}

TEST(Rmtr, CoarseModelsAgreeToFirstOrder) {
    NetHierarchy hierarchy(4, 2, buckling());
    QuadraticOptions options;
    const auto fine_solver = make_quadratic_solver(options), coarse_solver = make_quadratic_solver(options);
    const TrustRegionConstants constants;
    TrustRegionIterate fine(*hierarchy.levels[1], *fine_solver, constants);
    TrustRegionIterate coarse(*hierarchy.levels[0], *coarse_solver, constants);
    fine.start(hierarchy.finest().start(0.1) + 0.01 * random_vector(363, 1));
    const VecX restricted_gradient = restricted(*hierarchy.prolongations[0], fine.gradient());
    coarse.start(hierarchy.between[0]->project(fine.x()), restricted_gradient);
    EXPECT_LT((coarse.gradient() - restricted_gradient).norm(), 1e-12 * restricted_gradient.norm());
    // And the gradient is that of the tilted value.
    const VecX d = random_vector(147, 2), x0 = coarse.x();
    const double h = 1e-5;
    EXPECT_NEAR((coarse.value_at(x0 + h * d) - coarse.value_at(x0 - h * d)) / (2 * h), restricted_gradient.dot(d),
                1e-6 * restricted_gradient.norm());
    coarse.move_to(x0 + 0.01 * d, coarse.value_at(x0 + 0.01 * d));
    const VecX gradient = coarse.gradient(), x1 = coarse.x();
    EXPECT_NEAR((coarse.value_at(x1 + h * d) - coarse.value_at(x1 - h * d)) / (2 * h), gradient.dot(d),
                1e-6 * gradient.norm());
}

TEST(Rmtr, FindsTheMinimumOfASaggingNetInFewCyclesOnAnyNumberOfLevels) {
    std::vector<int> cycles;
    for (int count : {2, 3, 4}) {
        NetHierarchy hierarchy(2, count, NetLaw{});
        const double expected = reference_value(hierarchy, hierarchy.finest().start(0));
        VecX x = hierarchy.finest().start(0);
        double last = hierarchy.finest().value(x);
        Context context;
        const RmtrSummary summary =
            minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, {}, context, [&](const RmtrCycle& cycle) {
                EXPECT_LE(cycle.value, last + 1e-13 * std::max(1e-3, std::abs(last)));
                last = cycle.value;
                for (const RmtrLevelWork& level : cycle.levels)
                    EXPECT_LE(level.largest_correction, 1 + 1e-9);
            });
        EXPECT_TRUE(summary.converged()) << summary.message;
        EXPECT_NEAR(summary.value, expected, 1e-8 * std::abs(expected));
        EXPECT_EQ(summary.value, hierarchy.finest().value(x));
        cycles.push_back(summary.cycles);
    }
    EXPECT_LE(cycles.back(), 12);
    EXPECT_LE(cycles.back(), cycles.front() + 2);
}

TEST(Rmtr, FindsTheMinimumOfABucklingNetWithEverySmoother) {
    NetHierarchy hierarchy(4, 3, buckling());
    const double expected = reference_value(hierarchy, hierarchy.finest().start(-0.1));
    for (const Preconditioning smoother :
         {Preconditioning::block_jacobi, Preconditioning::block_gauss_seidel, Preconditioning::multigrid})
        for (int nested : {0, 10}) {
            VecX x = hierarchy.finest().start(-0.1);
            RmtrOptions options;
            options.finest = smoothing(smoother);
            if (smoother != Preconditioning::multigrid)
                options.smoother = smoothing(smoother);
            options.nested_cycles = nested;
            Context context;
            const RmtrSummary summary = minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, options, context);
            EXPECT_TRUE(summary.converged()) << summary.message;
            EXPECT_NEAR(summary.value, expected, 1e-8 * std::abs(expected));
            EXPECT_EQ(summary.nested_cycles > 0, nested > 0);
        }
}

TEST(Rmtr, EndsAtAMinimumFromAnUnstableStart) {
    NetLaw law;
    law.approach = 0.25;
    NetHierarchy hierarchy(4, 3, law);
    VecX start = hierarchy.finest().start(-1e-3);
    for (int i = 0; i < start.size(); i += 3)
        start[i] = 0.5 + 0.75 * (start[i] - 0.5); // compressed, and all but flat
    const double expected = reference_value(hierarchy, start);
    NewtonSystem& system = hierarchy.finest().system();
    hierarchy.finest().assemble(start, system, false);
    EXPECT_FALSE(ShiftedCholesky().try_factorize(system, 0));
    for (const QuadraticOptions& finest :
         {smoothing_by_block_jacobi(), smoothing(Preconditioning::multigrid), newton_by_multigrid()}) {
        VecX x = start;
        RmtrOptions options;
        options.finest = finest;
        Context context;
        const RmtrSummary summary = minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, options, context);
        EXPECT_TRUE(summary.converged()) << summary.message;
        EXPECT_LE(summary.cycles, 20);
        EXPECT_NEAR(summary.value, expected, 1e-8 * std::abs(expected));
        hierarchy.finest().assemble(x, system, false);
        EXPECT_TRUE(ShiftedCholesky().try_factorize(system, 0));
    }
}

TEST(Rmtr, NewtonStepsByMultigridConvergeWithOrWithoutCorrections) {
    NetHierarchy hierarchy(4, 3, buckling());
    const double expected = reference_value(hierarchy, hierarchy.finest().start(-0.1));
    for (const double least_restricted : {0.0, 1e9})
        for (const int nested : {0, 10}) {
            VecX x = hierarchy.finest().start(-0.1);
            RmtrOptions options;
            options.finest = newton_by_multigrid();
            options.least_restricted = least_restricted;
            options.nested_cycles = nested;
            Context context;
            const RmtrSummary summary = minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, options, context);
            EXPECT_TRUE(summary.converged()) << summary.message;
            EXPECT_LE(summary.cycles, 12);
            EXPECT_NEAR(summary.value, expected, 1e-8 * std::abs(expected));
            EXPECT_EQ(summary.levels.back().corrections_accepted > 0, least_restricted == 0);
        }
}

TEST(Rmtr, CountsWorkInUnitsOfTheFinestLevel) {
    NetHierarchy hierarchy(2, 3, NetLaw{});
    VecX x = hierarchy.finest().start(0);
    RmtrOptions options;
    options.retries = 0;
    options.longest_rest = 0;
    options.least_restricted = 0;
    Context context;
    double quadratic_units = 0;
    int full_cycles = 0;
    const RmtrSummary summary =
        minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, options, context, [&](const RmtrCycle& cycle) {
            const double units = plisse::quadratic_units(cycle.levels);
            quadratic_units += units;
            double solves = 0, products = 0;
            for (std::size_t l = 0; l < cycle.levels.size(); ++l) {
                const double share = std::pow(0.25, 2 - static_cast<int>(l));
                solves += share * cycle.levels[l].quadratic_solves;
                products += share * cycle.levels[l].quadratic_products;
                // Ten steps of conjugate gradients and two products for the plane of a step at the boundary.
                EXPECT_LE(cycle.levels[l].quadratic_products, 12.0 * cycle.levels[l].quadratic_solves);
                EXPECT_GE(cycle.levels[l].quadratic_products, cycle.levels[l].quadratic_iterations);
            }
            EXPECT_DOUBLE_EQ(units, solves);
            EXPECT_DOUBLE_EQ(product_units(cycle.levels), products / 10);
            full_cycles += std::abs(units - 2.5625) < 1e-12; // 2 + 2/4 + 1/16
        });
    EXPECT_NEAR(plisse::quadratic_units(summary.levels), quadratic_units, 1e-9);
    EXPECT_LE(assembly_units(summary.levels), quadratic_units);
    EXPECT_EQ(summary.levels.front().quadratic_products, 10.0 * summary.levels.front().quadratic_solves); // by a factor
    EXPECT_GE(full_cycles, summary.cycles / 2);
    EXPECT_GE(summary.cycles, 4);
}

TEST(Rmtr, IsTheTrustRegionMethodOnOneLevel) {
    NetHierarchy hierarchy(4, 1, buckling());
    VecX x = hierarchy.finest().start(-0.1), y = x;
    RmtrOptions options;
    options.retries = 0;
    TrustRegionOptions single;
    single.constants = options.constants;
    single.quadratic = options.coarsest;
    Context context;
    const RmtrSummary summary = minimize_by_rmtr(hierarchy.levels, {}, x, options, context);
    const TrustRegionSummary other = minimize_by_trust_region(hierarchy.finest(), y, single, context);
    EXPECT_TRUE(summary.converged());
    EXPECT_EQ(summary.cycles, other.iterations);
    EXPECT_EQ(x, y);
}

TEST(Rmtr, EndsHonestly) {
    NetHierarchy hierarchy(2, 3, buckling());
    RmtrOptions options;
    options.stop.max_iterations = 2;
    Context context;
    VecX x = hierarchy.finest().start(-0.1);
    const RmtrSummary capped = minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, options, context);
    EXPECT_EQ(capped.end, TrustRegionEnd::iteration_cap);
    EXPECT_EQ(capped.cycles, 2);
    EXPECT_FALSE(capped.converged());

    context.cancel();
    const VecX before = x;
    const RmtrSummary cancelled = minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, options, context);
    EXPECT_EQ(cancelled.end, TrustRegionEnd::interrupted);
    EXPECT_EQ(x, before);
}

TEST(Rmtr, IsInterruptedWithinACycleWithAPointThatIsNoWorse) {
    NetHierarchy hierarchy(2, 3, buckling());
    Context context;
    VecX x = hierarchy.finest().start(-0.1);
    const double before = hierarchy.finest().value(x);
    const RmtrSummary summary =
        minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, {}, context, [&](const RmtrCycle& cycle) {
            if (cycle.cycle == 2)
                context.cancel();
        });
    EXPECT_EQ(summary.end, TrustRegionEnd::interrupted);
    EXPECT_EQ(summary.cycles, 2);
    EXPECT_LT(hierarchy.finest().value(x), before);
}

TEST(Rmtr, KeepsToTheLargestSafeStepOnEveryLevel) {
    NetHierarchy hierarchy(2, 3, buckling());
    const double expected = reference_value(hierarchy, hierarchy.finest().start(-0.1));
    for (const auto& net : hierarchy.nets)
        net->largest_move = 0.01;
    VecX x = hierarchy.finest().start(-0.1);
    Context context;
    const RmtrSummary summary = minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, {}, context);
    EXPECT_TRUE(summary.converged()) << summary.message;
    EXPECT_NEAR(summary.value, expected, 1e-8 * std::abs(expected));
}

TEST(Rmtr, GivesTheSameBitsForAnyThreadCount) {
    std::vector<VecX> results;
    for (int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        NetHierarchy hierarchy(4, 3, buckling());
        VecX x = hierarchy.finest().start(-0.1);
        RmtrOptions options;
        options.finest = smoothing(Preconditioning::multigrid);
        options.stop.max_iterations = 3;
        Context context;
        minimize_by_rmtr(hierarchy.levels, hierarchy.between, x, options, context);
        results.push_back(x);
    }
    EXPECT_EQ(results[0], results[1]);
}

} // namespace
