#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <plisse/base/parallel.h>
#include <plisse/base/random.h>
#include <plisse/linalg/cholesky.h>

#include "linalg/dense_system.h"

using namespace plisse;

namespace {

/// A grid of vertices coupled with the eight around them and with a few far away, as contact does.
struct Grid {
    int side;
    std::vector<Edge> pairs, far;

    Grid(int vertices_a_side, int far_pairs, std::uint64_t seed) : side(vertices_a_side) {
        const auto vertex = [&](int i, int j) { return i * side + j; };
        for (int i = 0; i < side; ++i)
            for (int j = 0; j < side; ++j)
                for (const auto& [di, dj] : {std::pair{0, 1}, {1, 0}, {1, 1}, {1, -1}})
                    if (i + di < side && j + dj >= 0 && j + dj < side)
                        pairs.push_back({vertex(i, j), vertex(i + di, j + dj)});
        Random random(seed);
        while (static_cast<int>(far.size()) < far_pairs) {
            const int a = static_cast<int>(random.uniform(0, side * side));
            const int b = static_cast<int>(random.uniform(0, side * side));
            if (a != b)
                far.push_back({a, b});
        }
    }
    int vertex_count() const { return side * side; }

    NewtonSystem system() const { return {std::vector<std::uint8_t>(3 * at(vertex_count()), 0), pairs}; }

    /// Random springs along all pairs, and a little on the diagonal.
    void assemble(NewtonSystem& system, std::uint64_t seed) const {
        Random random(seed);
        system.begin(far);
        for (int v = 0; v < vertex_count(); ++v)
            system.add_block(v, v, 0.01 * Mat3::Identity());
        for (const auto* list : {&pairs, &far})
            for (const Edge& pair : *list) {
                Mat3 a;
                for (double& entry : a.reshaped())
                    entry = random.uniform(-1, 1);
                const Mat3 spring = a * a.transpose();
                Eigen::Matrix<double, 6, 6> element;
                element << spring, -spring, -spring, spring;
                system.add(pair, element);
            }
    }

    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
};

VecX ramp(int size) {
    return VecX::LinSpaced(size, -1, 2);
}

TEST(SparseCholesky, SolvesGridsOfManySizesAsADenseFactorisationDoes) {
    for (const int side : {1, 2, 5, 16})
        for (const int far : {0, side / 2}) {
            const Grid grid(side, side > 1 ? far : 0, 7);
            NewtonSystem system = grid.system();
            grid.assemble(system, 3);
            SparseCholesky cholesky;
            ASSERT_TRUE(cholesky.factorize(system));
            const VecX b = ramp(3 * grid.vertex_count());
            const VecX expected = dense(system).ldlt().solve(b);
            EXPECT_LT((cholesky.solve(b) - expected).norm(), 1e-9 * expected.norm()) << side << " " << far;
        }
}

TEST(SparseCholesky, SolvesAGraphInPiecesAndAnEmptyOne) {
    const std::vector<Edge> pairs = {{0, 3}, {5, 4}};
    NewtonSystem pieces(std::vector<std::uint8_t>(21, 0), pairs);
    pieces.begin({});
    for (int v = 0; v < 7; ++v)
        pieces.add_block(v, v, (v + 2) * Mat3::Identity());
    pieces.add_block(3, 0, Mat3::Identity());
    SparseCholesky cholesky;
    ASSERT_TRUE(cholesky.factorize(pieces));
    const VecX b = ramp(21);
    EXPECT_LT((dense(pieces) * cholesky.solve(b) - b).norm(), 1e-13);

    NewtonSystem empty(std::vector<std::uint8_t>(6, 1), std::vector<Edge>{{0, 1}});
    empty.begin({});
    SparseCholesky nothing;
    EXPECT_TRUE(nothing.factorize(empty));
    EXPECT_EQ(nothing.solve(VecX(0)).size(), 0);
}

TEST(SparseCholesky, KeepsItsOrderWhileThePatternGrowsALittle) {
    Grid grid(12, 0, 1);
    NewtonSystem system = grid.system();
    grid.assemble(system, 3);
    SparseCholesky cholesky;
    ASSERT_TRUE(cholesky.factorize(system));
    grid.far = {{0, 26}, {40, 66}};
    grid.assemble(system, 4);
    ASSERT_TRUE(cholesky.factorize(system));
    EXPECT_EQ(cholesky.ordering_count(), 1);
    const VecX b = ramp(3 * grid.vertex_count());
    EXPECT_LT((dense(system) * cholesky.solve(b) - b).norm(), 1e-9);
    cholesky.reset();
    ASSERT_TRUE(cholesky.factorize(system));
    EXPECT_EQ(cholesky.ordering_count(), 2);
}

TEST(SparseCholesky, GivesTheSameBitsOnAnyNumberOfThreads) {
    const Grid grid(70, 200, 5); // large enough that fronts are worked on at a time
    NewtonSystem system = grid.system();
    grid.assemble(system, 6);
    const VecX b = ramp(3 * grid.vertex_count());
    const auto solved_on = [&](int threads) {
        const ThreadLimit limit(threads);
        SparseCholesky cholesky;
        EXPECT_TRUE(cholesky.factorize(system));
        return cholesky.solve(b);
    };
    const VecX on_one = solved_on(1);
    for (int attempt = 0; attempt < 5; ++attempt)
        EXPECT_TRUE(solved_on(2) == on_one);
}

TEST(SparseCholesky, SaysWhenTheMatrixIsIndefinite) {
    const Grid grid(40, 50, 9);
    NewtonSystem system = grid.system();
    grid.assemble(system, 6);
    system.add_block(777, 777, -100 * Mat3::Identity());
    SparseCholesky cholesky;
    EXPECT_FALSE(cholesky.factorize(system));
    ASSERT_TRUE(cholesky.factorize(system, 200.0));
    const VecX b = ramp(3 * grid.vertex_count());
    const VecX x = cholesky.solve(b);
    EXPECT_LT((dense(system) * x + 200 * x - b).norm(), 1e-10 * b.norm());
}

} // namespace
