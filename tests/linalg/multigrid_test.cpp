#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Eigenvalues>

#include "linalg/dense_system.h"
#include "linalg/grid_system.h"
#include "linalg/spline_grid.h"
#include <plisse/base/parallel.h>
#include <plisse/linalg/multigrid.h>

using namespace plisse;

namespace {

Eigen::MatrixXd for_vertices(const ScalarTransfer& s) {
    const Eigen::MatrixXd scalar = s;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * s.rows(), 3 * s.cols());
    for (int j = 0; j < s.cols(); ++j)
        for (int i = 0; i < s.rows(); ++i)
            result.block<3, 3>(3 * i, 3 * j) = scalar(i, j) * Mat3::Identity();
    return result;
}

Eigen::MatrixXd as_matrix(const Preconditioner& preconditioner, Eigen::Index size) {
    Eigen::MatrixXd result(size, size);
    for (int j = 0; j < size; ++j)
        result.col(j) = preconditioner.apply(VecX::Unit(size, j));
    return result;
}

double lowest_eigenvalue(const Eigen::MatrixXd& matrix) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// Random table with a few weights a row.
ScalarTransfer random_table(int rows, int columns, std::uint64_t seed) {
    Random random(seed);
    spline::Triplets entries;
    for (int i = 0; i < rows; ++i)
        for (int k = 0; k < 3; ++k)
            entries.emplace_back(i, random.below(columns), random.uniform(-1, 1));
    return spline::table(rows, columns, entries);
}

struct Hierarchy {
    std::vector<ScalarTransfer> tables;
    std::vector<const ScalarTransfer*> pointers;
    Hierarchy(int coarsest, int levels) {
        for (int l = 0; l < levels; ++l)
            tables.push_back(spline::tensor(spline::subdivision_1d(coarsest << l)));
        for (const ScalarTransfer& table : tables)
            pointers.push_back(&table);
    }
};

/// Largest ratio of errors in the energy norm that repeated cycles come to.
double convergence_factor(const NewtonSystem& system, const Preconditioner& cycle) {
    VecX error = random_vector(3 * system.row_count(), 3);
    double factor = 0;
    for (int k = 0; k < 25; ++k) {
        const double before = std::sqrt(error.dot(system.multiply(error)));
        error -= cycle.apply(system.multiply(error));
        const double after = std::sqrt(error.dot(system.multiply(error)));
        factor = after / before;
        error /= after;
    }
    return factor;
}

TEST(ScalarTransfer, IsItsMatrixOnEachAxis) {
    const ScalarTransfer s = random_table(9, 5, 1);
    const VecX coarse = random_vector(15, 2), fine = random_vector(27, 3);
    EXPECT_LT((prolonged(s, coarse) - for_vertices(s) * coarse).norm(), 1e-14);
    EXPECT_LT((restricted(s, fine) - for_vertices(s).transpose() * fine).norm(), 1e-14);
    EXPECT_GE(norm_bound(s), for_vertices(s).jacobiSvd().singularValues()[0]);
    EXPECT_NEAR(norm_bound(spline::tensor(spline::subdivision_1d(8))), 2, 1e-14);
}

TEST(ScalarTransfer, ReverseSubdivisionOfTheTestsIsALeftInverse) {
    for (int n : {4, 8}) {
        const Eigen::MatrixXd product =
            spline::tensor(spline::projection_1d(n)) * spline::tensor(spline::subdivision_1d(n));
        EXPECT_LT((product - Eigen::MatrixXd::Identity(product.rows(), product.cols())).norm(), 1e-12);
    }
}

TEST(TripleProduct, IsTheDenseProductWhateverThePattern) {
    const Grid grid(8, 6, 5);
    const ScalarTransfer s = random_table(64, 20, 7);
    NewtonSystem fine = grid.system();
    TripleProduct product(s);
    int version = -1;
    for (std::uint64_t seed : {1, 2}) {
        fine.begin({});
        const Eigen::MatrixXd table = for_vertices(s);
        if (seed == 1)
            Grid(8, 0, 5).assemble(fine, seed);
        else
            grid.assemble(fine, seed); // with pairs that are new
        const NewtonSystem& coarse = product.compute(fine);
        const Eigen::MatrixXd expected = table.transpose() * dense(fine) * table;
        EXPECT_LT((dense(coarse) - expected).norm(), 1e-13 * expected.norm());
        EXPECT_GE(coarse.pattern_version(), version);
        version = coarse.pattern_version();
    }
}

TEST(TripleProduct, OfSplinesIsTheSameFormOnTheCoarseGrid) {
    const NewtonSystem fine = spline::plate(8, 3);
    const ScalarTransfer s = spline::tensor(spline::subdivision_1d(4));
    TripleProduct product(s);
    const Eigen::MatrixXd coarse = dense(product.compute(fine)), expected = dense(spline::plate(4, 3));
    EXPECT_LT((coarse - expected).norm(), 1e-12 * expected.norm());
    EXPECT_EQ(product.compute(fine).blocks().size(), spline::plate(4, 3).blocks().size()); // no fill
}

class Preconditioning : public testing::TestWithParam<double> {};

TEST_P(Preconditioning, IsSymmetricAndDefinite) {
    const NewtonSystem system = spline::plate(4, GetParam());
    const Eigen::MatrixXd h = dense(system);
    EXPECT_EQ(lowest_eigenvalue(h) < 0, GetParam() < 0);
    const Hierarchy hierarchy(2, 1);
    std::vector<std::unique_ptr<Preconditioner>> all;
    all.push_back(std::make_unique<BlockJacobi>());
    all.push_back(std::make_unique<BlockGaussSeidel>());
    all.push_back(std::make_unique<Chebyshev>(3));
    for (Smoother smoother : {Smoother::block_jacobi, Smoother::block_gauss_seidel, Smoother::chebyshev})
        for (int steps : {1, 2})
            all.push_back(std::make_unique<Multigrid>(hierarchy.pointers, MultigridOptions{smoother, steps, 3}));
    for (std::size_t k = 0; k < all.size(); ++k) {
        SCOPED_TRACE(k);
        all[k]->set_matrix(system);
        const Eigen::MatrixXd inverse = as_matrix(*all[k], h.rows());
        EXPECT_LT((inverse - inverse.transpose()).norm(), 1e-9 * inverse.norm());
        EXPECT_GT(lowest_eigenvalue(0.5 * (inverse + inverse.transpose())), 0);
    }
}

// Above the lowest bending mode of a free plate: at 0 three rigid motions are singular.
INSTANTIATE_TEST_SUITE_P(DefiniteAndNot, Preconditioning, testing::Values(10.0, -300.0, -1000.0));

TEST(BlockGaussSeidel, IsTheProductOfItsTriangles) {
    const NewtonSystem system = spline::plate(4, 5);
    BlockGaussSeidel sweep;
    sweep.set_matrix(system);
    const Eigen::MatrixXd h = dense(system);
    Eigen::MatrixXd lower = Eigen::MatrixXd::Zero(h.rows(), h.cols()), diagonal = lower;
    for (int r = 0; r < system.row_count(); ++r) {
        lower.block(3 * r, 0, 3, 3 * r + 3) = h.block(3 * r, 0, 3, 3 * r + 3);
        diagonal.block<3, 3>(3 * r, 3 * r) = h.block<3, 3>(3 * r, 3 * r);
    }
    const VecX b = random_vector(h.rows(), 1);
    const VecX expected = lower.transpose().lu().solve(diagonal * lower.lu().solve(b));
    EXPECT_LT((sweep.apply(b) - expected).norm(), 1e-10 * expected.norm());
}

TEST(Multigrid, CountsItsProducts) {
    const Hierarchy hierarchy(3, 2);
    MultigridOptions options;
    // A level: two sweeps at one product each, and a residual before each but the first and for the coarser level.
    EXPECT_DOUBLE_EQ(Multigrid(hierarchy.pointers, options).products(), 4 + (4 + 10.0 / 4) / 4);
    options.steps = 2;
    EXPECT_DOUBLE_EQ(Multigrid(hierarchy.pointers, options).products(), 8 + (8 + 10.0 / 4) / 4);
    options.smoother = Smoother::block_jacobi;
    EXPECT_DOUBLE_EQ(Multigrid({}, options).products(), 10);
}

TEST(Multigrid, IsADirectSolverOnOneLevel) {
    const NewtonSystem system = spline::plate(4, 5);
    Multigrid cycle({}, {});
    cycle.set_matrix(system);
    const VecX b = random_vector(3 * system.row_count(), 1);
    EXPECT_LT((system.multiply(cycle.apply(b)) - b).norm(), 1e-8 * b.norm());
}

TEST(Multigrid, ConvergesAlikeOnAllSizes) {
    for (Smoother smoother : {Smoother::block_gauss_seidel, Smoother::chebyshev}) {
        std::vector<double> factors;
        for (int levels : {1, 2, 3}) {
            const Hierarchy hierarchy(4, levels);
            const NewtonSystem system = spline::plate(4 << levels, 1);
            Multigrid cycle(hierarchy.pointers, MultigridOptions{smoother, 1, 3});
            cycle.set_matrix(system);
            factors.push_back(convergence_factor(system, cycle));
            EXPECT_LT(factors.back(), 0.6);
        }
        EXPECT_LT(factors.back(), factors.front() + 0.1);
    }
}

TEST(Multigrid, GivesTheSameBitsForAnyThreadCount) {
    const NewtonSystem system = spline::plate(32, 1);
    const VecX b = random_vector(3 * system.row_count(), 1);
    std::vector<VecX> results;
    for (int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        const Hierarchy hierarchy(8, 2);
        Multigrid cycle(hierarchy.pointers, {});
        cycle.set_matrix(system);
        results.push_back(cycle.apply(b));
    }
    EXPECT_EQ(results[0], results[1]);
}

} // namespace
