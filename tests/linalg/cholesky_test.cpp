#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <plisse/base/parallel.h>
#include <plisse/linalg/cholesky.h>

#include "linalg/dense_system.h"
#include "linalg/grid_system.h"

using namespace plisse;

namespace {

/// A factorisation with a plan of its own.
template <typename Scalar>
struct Factor {
    FrontPlan plan;
    SparseCholesky<Scalar> cholesky;

    bool factorize(const NewtonSystem& system, double shift = 0) {
        plan.adapt_to(system);
        return cholesky.factorize(plan, system, shift);
    }
    VecX solve(const VecX& b) { return cholesky.solve(plan, b); }
};

template <typename Scalar>
class SparseCholeskyOf : public testing::Test {
protected:
    /// In units of a relative rounding error; the matrices below have conditions of up to 1e5.
    static constexpr double rounding(double units) { return units * std::numeric_limits<Scalar>::epsilon(); }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(SparseCholeskyOf, Precisions);

TYPED_TEST(SparseCholeskyOf, SolvesGridsOfManySizesAsADenseFactorisationDoes) {
    for (const int side : {1, 2, 5, 16})
        for (const int far : {0, side / 2}) {
            const Grid grid(side, side > 1 ? far : 0, 7);
            NewtonSystem system = grid.system();
            grid.assemble(system, 3);
            Factor<TypeParam> factor;
            ASSERT_TRUE(factor.factorize(system));
            const VecX b = ramp(3 * grid.vertex_count());
            const VecX expected = dense(system).ldlt().solve(b);
            EXPECT_LT((factor.solve(b) - expected).norm(), this->rounding(1e6) * expected.norm()) << side << " " << far;
        }
}

TYPED_TEST(SparseCholeskyOf, SolvesAGraphInPiecesAndAnEmptyOne) {
    const std::vector<Edge> pairs = {{0, 3}, {5, 4}};
    NewtonSystem pieces(std::vector<std::uint8_t>(21, 0), pairs);
    pieces.begin({});
    for (int v = 0; v < 7; ++v)
        pieces.add_block(v, v, (v + 2) * Mat3::Identity());
    pieces.add_block(3, 0, Mat3::Identity());
    Factor<TypeParam> factor;
    ASSERT_TRUE(factor.factorize(pieces));
    const VecX b = ramp(21);
    EXPECT_LT((dense(pieces) * factor.solve(b) - b).norm(), this->rounding(100));

    NewtonSystem empty(std::vector<std::uint8_t>(6, 1), std::vector<Edge>{{0, 1}});
    empty.begin({});
    Factor<TypeParam> nothing;
    EXPECT_TRUE(nothing.factorize(empty));
    EXPECT_EQ(nothing.solve(VecX(0)).size(), 0);
}

TYPED_TEST(SparseCholeskyOf, GivesTheSameBitsOnAnyNumberOfThreads) {
    const Grid grid(70, 200, 5); // large enough that fronts are worked on at a time
    NewtonSystem system = grid.system();
    grid.assemble(system, 6);
    const VecX b = ramp(3 * grid.vertex_count());
    const auto solved_on = [&](int threads) {
        const ThreadLimit limit(threads);
        Factor<TypeParam> factor;
        EXPECT_TRUE(factor.factorize(system));
        return factor.solve(b);
    };
    const VecX on_one = solved_on(1);
    for (int attempt = 0; attempt < 5; ++attempt)
        EXPECT_TRUE(solved_on(2) == on_one);
}

TYPED_TEST(SparseCholeskyOf, SaysWhenTheMatrixIsIndefinite) {
    const Grid grid(40, 50, 9);
    NewtonSystem system = grid.system();
    grid.assemble(system, 6);
    system.add_block(777, 777, -100 * Mat3::Identity());
    Factor<TypeParam> factor;
    EXPECT_FALSE(factor.factorize(system));
    ASSERT_TRUE(factor.factorize(system, 200.0));
    const VecX b = ramp(3 * grid.vertex_count());
    const VecX x = factor.solve(b);
    EXPECT_LT((dense(system) * x + 200 * x - b).norm(), this->rounding(100) * b.norm());
}

TEST(FrontPlan, KeepsItsOrderWhileThePatternGrowsALittle) {
    Grid grid(12, 0, 1);
    NewtonSystem system = grid.system();
    grid.assemble(system, 3);
    Factor<double> factor;
    ASSERT_TRUE(factor.factorize(system));
    grid.far = {{0, 26}, {40, 66}};
    grid.assemble(system, 4);
    ASSERT_TRUE(factor.factorize(system));
    EXPECT_EQ(factor.plan.ordering_count(), 1);
    const VecX b = ramp(3 * grid.vertex_count());
    EXPECT_LT((dense(system) * factor.solve(b) - b).norm(), 1e-9);
    factor.plan.reset();
    ASSERT_TRUE(factor.factorize(system));
    EXPECT_EQ(factor.plan.ordering_count(), 2);
}

} // namespace
