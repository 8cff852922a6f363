#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include <plisse/base/random.h>
#include <plisse/linalg/elimination.h>

using namespace plisse;

namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

/// A random symmetric pattern: the lower triangle by columns, the diagonal first.
struct Pattern {
    std::vector<int> starts{0}, rows;

    Pattern(int size, int couplings, std::uint64_t seed) {
        std::vector<std::set<int>> columns(at(size));
        for (int c = 0; c < size; ++c)
            columns[at(c)].insert(c);
        Random random(seed);
        for (int k = 0; k < couplings; ++k) {
            const int a = static_cast<int>(random.uniform(0, size)), b = static_cast<int>(random.uniform(0, size));
            columns[at(std::min(a, b))].insert(std::max(a, b));
        }
        for (const auto& column : columns) {
            rows.insert(rows.end(), column.begin(), column.end());
            starts.push_back(static_cast<int>(rows.size()));
        }
    }
    int size() const { return static_cast<int>(starts.size()) - 1; }

    /// For every position in the order, the positions behind it that elimination by the book couples it with.
    std::vector<std::set<int>> eliminated(const std::vector<int>& order) const {
        std::vector<int> position(order.size());
        for (std::size_t p = 0; p < order.size(); ++p)
            position[at(order[p])] = static_cast<int>(p);
        std::vector<std::set<int>> later(order.size());
        for (int c = 0; c < size(); ++c)
            for (int k = starts[at(c)] + 1; k < starts[at(c) + 1]; ++k) {
                const int a = position[at(c)], b = position[at(rows[at(k)])];
                later[at(std::min(a, b))].insert(std::max(a, b));
            }
        for (auto& column : later)
            for (const int row : column)
                for (const int other : column)
                    if (other > row)
                        later[at(row)].insert(other);
        return later;
    }
};

TEST(Elimination, FrontsHoldAllFillAndHandItOn) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const Pattern pattern(60, static_cast<int>(15 * seed), seed);
        const Elimination e =
            analyze_elimination(pattern.starts, pattern.rows, dissection_order(pattern.starts, pattern.rows));
        std::vector<int> sorted = e.order, all(60);
        std::sort(sorted.begin(), sorted.end());
        std::iota(all.begin(), all.end(), 0);
        ASSERT_EQ(sorted, all);
        ASSERT_EQ(e.first_pivot.back(), 60);
        const auto fill = pattern.eliminated(e.order);
        const auto row_in = [&](int front, int index) {
            const int pivots = e.pivot_count(front);
            return index < pivots ? e.first_pivot[at(front)] + index : e.reach_of(front)[at(index - pivots)];
        };
        for (int f = 0; f < e.front_count(); ++f) {
            const auto reach = e.reach_of(f);
            EXPECT_TRUE(std::is_sorted(reach.begin(), reach.end()));
            for (int p = e.first_pivot[at(f)]; p < e.first_pivot[at(f) + 1]; ++p)
                for (const int row : fill[at(p)])
                    EXPECT_TRUE(row < e.first_pivot[at(f) + 1] || std::binary_search(reach.begin(), reach.end(), row));
            if (e.parent[at(f)] < 0) {
                EXPECT_TRUE(reach.empty());
                continue;
            }
            EXPECT_GT(e.parent[at(f)], f);
            for (std::size_t k = 0; k < reach.size(); ++k)
                EXPECT_EQ(row_in(e.parent[at(f)], e.place_of(f)[k]), reach[k]);
        }
    }
}

TEST(Elimination, SubtreesAreContiguousAndTheirCostsAddUp) {
    const Pattern pattern(300, 500, 4);
    const Elimination e =
        analyze_elimination(pattern.starts, pattern.rows, dissection_order(pattern.starts, pattern.rows));
    std::vector<double> below(at(e.front_count()), 0);
    for (int f = 0; f < e.front_count(); ++f) {
        EXPECT_GT(e.cost[at(f)], below[at(f)]);
        const int parent = e.parent[at(f)];
        if (parent >= 0) {
            EXPECT_LE(e.first_below[at(parent)], e.first_below[at(f)]);
            below[at(parent)] += e.cost[at(f)];
        }
        for (int g = e.first_below[at(f)]; g < f; ++g)
            EXPECT_TRUE(e.parent[at(g)] >= 0 && e.parent[at(g)] <= f);
    }
}

TEST(Elimination, AChainBecomesFewSmallFronts) {
    Pattern chain(1, 0, 1);
    chain.starts = {0};
    chain.rows.clear();
    for (int v = 0; v < 1000; ++v) {
        chain.rows.push_back(v);
        if (v + 1 < 1000)
            chain.rows.push_back(v + 1);
        chain.starts.push_back(static_cast<int>(chain.rows.size()));
    }
    std::vector<int> natural(1000);
    std::iota(natural.begin(), natural.end(), 0);
    const Elimination e = analyze_elimination(chain.starts, chain.rows, natural);
    EXPECT_LT(e.front_count(), 500);
    EXPECT_LT(e.factor_entries(), 0.05 * 3000 * 3001 / 2);
    for (int f = 0; f < e.front_count(); ++f)
        EXPECT_LE(e.reach_of(f).size(), 1U);
}

} // namespace
