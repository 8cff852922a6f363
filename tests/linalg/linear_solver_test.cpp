#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include <Eigen/Cholesky>

#include <plisse/base/parallel.h>
#include <plisse/linalg/linear_solver.h>
#include <plisse/linalg/multigrid.h>

#include "linalg/dense_system.h"
#include "linalg/grid_system.h"

using namespace plisse;

namespace {

NewtonSystem assembled(const Grid& grid, std::uint64_t seed) {
    NewtonSystem system = grid.system();
    grid.assemble(system, seed);
    return system;
}

/// sqrt(e . H e) / sqrt(x . H x), with e the error.
double energy_error(const NewtonSystem& system, const VecX& x, const VecX& expected) {
    const Eigen::MatrixXd h = dense(system);
    const VecX error = x - expected;
    return std::sqrt(error.dot(h * error) / expected.dot(h * expected));
}

TEST(LinearSolver, SolvesInDoublePrecisionWithAFactorInSingle) {
    const Grid grid(20, 15, 7);
    const NewtonSystem system = assembled(grid, 3);
    LinearSolver solver;
    ASSERT_TRUE(solver.try_factorize(system));
    const VecX b = ramp(3 * grid.vertex_count());
    const VecX expected = dense(system).ldlt().solve(b);
    const double rough = energy_error(system, solver.solve_roughly(b), expected);
    const double fine = energy_error(system, solver.solve(system, b), expected);
    EXPECT_GT(rough, 1e-9);
    EXPECT_LT(rough, 1e-3);
    EXPECT_LT(fine, 1e-6);
}

TEST(LinearSolver, SolvesForRightHandSidesOutsideTheRangeOfSinglePrecision) {
    const Grid grid(8, 4, 7);
    const NewtonSystem system = assembled(grid, 3);
    LinearSolver solver;
    solver.factorize(system);
    const VecX b = ramp(3 * grid.vertex_count());
    const VecX x = solver.solve(system, b);
    EXPECT_LT((1e60 * solver.solve(system, 1e-60 * b) - x).norm(), 1e-9 * x.norm());
    EXPECT_LT((1e-60 * solver.solve(system, 1e60 * b) - x).norm(), 1e-9 * x.norm());
    EXPECT_EQ(solver.solve(system, 0 * b), VecX::Zero(b.size()));
}

/// Chains of stiff springs that hold on to nothing but a very soft one: to single precision they hold on to nothing.
NewtonSystem loose_chain(int length, double hold) {
    std::vector<Edge> pairs;
    for (int v = 1; v < length; ++v)
        pairs.push_back({v - 1, v});
    NewtonSystem system(std::vector<std::uint8_t>(3 * static_cast<std::size_t>(length), 0), pairs);
    system.begin({});
    Eigen::Matrix<double, 6, 6> spring;
    spring << Mat3::Identity(), -Mat3::Identity(), -Mat3::Identity(), Mat3::Identity();
    for (const Edge& pair : pairs)
        system.add(pair, spring);
    system.add_block(0, 0, hold * Mat3::Identity());
    return system;
}

TEST(LinearSolver, GoesOnInDoublePrecisionWhereSingleDoesNotDo) {
    const NewtonSystem system = loose_chain(300, 1e-9);
    LinearSolver solver;
    EXPECT_EQ(solver.factorize(system), 0);
    const VecX b = VecX::Ones(900);
    const VecX x = solver.solve(system, b);
    EXPECT_LT((dense(system) * x - b).norm(), 1e-3 * b.norm()); // |x| is 3e11, so that b is found by cancellation
    EXPECT_LT(std::abs(x[0] - 300 / 1e-9), 1e-5 * x[0]);        // the soft spring bears all
}

TEST(LinearSolver, ShiftsByNoMoreThanItTakes) {
    NewtonSystem system = loose_chain(50, 0);
    LinearSolver solver;
    const double shift = solver.factorize(system);
    EXPECT_LE(shift, 1e-9);
    system.add_block(20, 20, -0.5 * Mat3::Identity());
    EXPECT_FALSE(solver.try_factorize(system));
    const double larger = solver.factorize(system);
    EXPECT_GT(larger, 1e-3);
    const VecX b = ramp(150);
    const VecX x = solver.solve(system, b);
    EXPECT_LT((dense(system) * x + larger * x - b).norm(), 1e-9 * b.norm());
}

TEST(LinearSolver, RefusesWhatNoShiftMakesDefinite) {
    NewtonSystem system = loose_chain(3, 1);
    system.add_block(1, 1, std::nan("") * Mat3::Identity());
    EXPECT_THROW(LinearSolver().factorize(system), std::runtime_error);
    EXPECT_THROW(ShiftedCholesky().factorize(system), std::runtime_error);
}

TEST(LinearSolver, DescendsWhereHIsIndefiniteByLessThanSinglePrecisionSees) {
    // Moved by 1e-9 of itself, the chain's softest stiffness changes its sign, or not, as rounding has it.
    for (const double hold : {-1e-9, -1e-8, -3e-8, -1e-7}) {
        const NewtonSystem system = loose_chain(30, hold);
        LinearSolver solver;
        if (!solver.try_factorize(system))
            continue;
        const VecX b = ramp(90);
        EXPECT_GT(solver.solve(system, b).dot(b), 0) << hold;
    }
}

TEST(LinearSolver, GivesTheSameBitsOnAnyNumberOfThreadsAndAfterAReset) {
    const Grid grid(70, 200, 5);
    const NewtonSystem system = assembled(grid, 6);
    const VecX b = ramp(3 * grid.vertex_count());
    LinearSolver solver;
    const auto solved_on = [&](int threads) {
        const ThreadLimit limit(threads);
        solver.reset();
        solver.factorize(system);
        return solver.solve(system, b);
    };
    const VecX on_one = solved_on(1);
    EXPECT_TRUE(solved_on(2) == on_one);
    EXPECT_TRUE(solved_on(1) == on_one);
}

} // namespace
