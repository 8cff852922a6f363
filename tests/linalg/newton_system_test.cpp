#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <plisse/base/random.h>
#include <plisse/linalg/newton_system.h>

#include "linalg/dense_system.h"

using namespace plisse;

namespace {

/// A chain of n vertices with random positive definite elements over neighbours, dense for comparison.
struct Chain {
    int n;
    std::vector<Edge> pairs;
    std::vector<Eigen::Matrix<double, 6, 6>> elements;
    Eigen::MatrixXd dense;

    explicit Chain(int count, std::uint64_t seed) : n(count), dense(Eigen::MatrixXd::Zero(3 * count, 3 * count)) {
        Random random(seed);
        for (int v = 0; v + 1 < n; ++v) {
            Eigen::Matrix<double, 6, 6> a;
            for (double& entry : a.reshaped())
                entry = random.uniform(-1, 1);
            add({v, v + 1}, a * a.transpose() + 0.1 * Eigen::Matrix<double, 6, 6>::Identity());
        }
    }
    void add(const Edge& pair, const Eigen::Matrix<double, 6, 6>& element) {
        pairs.push_back(pair);
        elements.push_back(element);
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                dense.block<3, 3>(3 * pair[static_cast<std::size_t>(i)], 3 * pair[static_cast<std::size_t>(j)]) +=
                    element.block<3, 3>(3 * i, 3 * j);
    }
    void assemble(NewtonSystem& system, std::span<const Edge> extra = {}) const {
        system.begin(extra);
        for (std::size_t e = 0; e < pairs.size(); ++e)
            system.add(pairs[e], elements[e]);
    }
};

VecX random_vector(int size, std::uint64_t seed) {
    Random random(seed);
    VecX v(size);
    for (double& entry : v)
        entry = random.uniform(-1, 1);
    return v;
}

TEST(NewtonSystem, MultipliesAsADenseMatrixDoes) {
    const Chain chain(12, 1);
    NewtonSystem system(std::vector<std::uint8_t>(36, 0), chain.pairs);
    chain.assemble(system);
    const VecX v = random_vector(36, 2);
    const VecX expected = chain.dense * v;
    EXPECT_LT((system.scatter(system.multiply(system.gather(v))) - expected).norm(), 1e-14 * expected.norm());
}

TEST(NewtonSystem, CondensesPrescribedUnknowns) {
    const Chain chain(6, 3);
    std::vector<std::uint8_t> prescribed(18, 0);
    for (int scalar : {0, 1, 2, 7, 15, 16})
        prescribed[static_cast<std::size_t>(scalar)] = 1;
    NewtonSystem system(prescribed, chain.pairs);
    EXPECT_EQ(system.row_count(), 5); // vertex 0 has no row
    VecX u = VecX::Zero(18);
    for (int scalar = 0; scalar < 18; ++scalar)
        if (prescribed[static_cast<std::size_t>(scalar)])
            u[scalar] = 0.1 * (scalar + 1);
    system.set_prescribed_step(u);
    chain.assemble(system);
    EXPECT_LT((system.coupling() - chain.dense * u).norm(), 1e-12);

    const VecX g = random_vector(18, 4);
    const VecX d = system.scatter(dense(system).ldlt().solve(system.gather(-g - system.coupling()))) + u;
    const VecX residual = chain.dense * d + g; // zero on free rows
    for (int scalar = 0; scalar < 18; ++scalar) {
        if (prescribed[static_cast<std::size_t>(scalar)])
            EXPECT_DOUBLE_EQ(d[scalar], u[scalar]);
        else
            EXPECT_NEAR(residual[scalar], 0, 1e-11);
    }
}

TEST(NewtonSystem, TakesExtraPairsAndForgetsThem) {
    Chain chain(8, 5);
    NewtonSystem system(std::vector<std::uint8_t>(24, 0), chain.pairs);
    const int base_version = system.pattern_version();
    const std::size_t base_blocks = system.block_rows().size();
    const Eigen::Matrix<double, 6, 6> spring = Eigen::Matrix<double, 6, 6>::Identity();
    chain.add({0, 7}, spring);
    chain.add({2, 6}, spring);
    const std::vector<Edge> extra = {{7, 0}, {2, 6}};
    chain.assemble(system, extra);
    EXPECT_GT(system.pattern_version(), base_version);
    const int grown_version = system.pattern_version();
    chain.assemble(system, extra);
    EXPECT_EQ(system.pattern_version(), grown_version);

    const VecX b = random_vector(24, 6);
    const VecX expected = chain.dense.ldlt().solve(b);
    EXPECT_LT((system.scatter(dense(system).ldlt().solve(system.gather(b))) - expected).norm(),
              1e-11 * expected.norm());

    system.reset_pattern();
    EXPECT_EQ(system.block_rows().size(), base_blocks);
}

TEST(NewtonSystem, AddsAtNumbersWhatItAddsBySearching) {
    Chain chain(9, 7);
    std::vector<std::uint8_t> prescribed(27, 0);
    for (int scalar : {0, 1, 2, 13}) // all of vertex 0, one axis of vertex 4
        prescribed[static_cast<std::size_t>(scalar)] = 1;
    NewtonSystem searched(prescribed, chain.pairs), numbered(prescribed, chain.pairs);
    std::vector<int> numbers;
    for (const Edge& pair : chain.pairs)
        numbered.append_base_blocks(pair, numbers);
    EXPECT_EQ(numbered.base_block(0, 0), -1);
    EXPECT_EQ(numbered.base_block(5, 4), -1);
    for (NewtonSystem* system : {&searched, &numbered})
        system->set_prescribed_step(random_vector(27, 8));
    const std::vector<Edge> extra = {{8, 3}}; // numbers hold while the pattern changes
    chain.assemble(searched, extra);
    numbered.begin(extra);
    for (std::size_t e = 0; e < chain.pairs.size(); ++e)
        numbered.add(chain.pairs[e], numbers.data() + 3 * e, chain.elements[e]);
    EXPECT_EQ(numbered.blocks(), searched.blocks());
    EXPECT_EQ(numbered.coupling(), searched.coupling());
    EXPECT_GT(numbered.coupling().norm(), 0);
}

} // namespace
