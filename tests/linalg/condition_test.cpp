#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Eigenvalues>

#include "linalg/dense_system.h"
#include "linalg/grid_system.h"
#include <plisse/linalg/condition.h>

namespace plisse {
namespace {

TEST(Condition, IsThatOfTheDenseMatrix) {
    const Grid grid(9, 12, 3);
    NewtonSystem system = grid.system();
    grid.assemble(system, 5);
    const VecX values =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense(system), Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_NEAR(condition_number(system), values.maxCoeff() / values.minCoeff(),
                1e-6 * values.maxCoeff() / values.minCoeff());
}

TEST(Condition, IsInfiniteWithoutAFactor) {
    const Grid grid(3, 0, 1);
    NewtonSystem system = grid.system();
    grid.assemble(system, 5);
    system.add_block(4, 4, -1e3 * Mat3::Identity());
    EXPECT_EQ(condition_number(system), std::numeric_limits<double>::infinity());
}

TEST(Condition, LargestEigenvalueOfFewDimensionsIsExact) {
    const VecX diagonal = VecX::LinSpaced(4, 1, 7);
    const auto apply = [&](const VecX& v) { return VecX(diagonal.cwiseProduct(v)); };
    EXPECT_NEAR(largest_eigenvalue(4, apply), 7, 1e-12);
}

} // namespace
} // namespace plisse
