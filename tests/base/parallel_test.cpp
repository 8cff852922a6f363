#include <plisse/base/parallel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

namespace plisse {
namespace {

double awkward_term(int i) {
    return std::sin(1.0 + i) * std::pow(10.0, i % 17 - 8);
}

TEST(ParallelSum, HasTheSameBitsForAnyNumberOfThreads) {
    for (int count : {0, 1, 511, 512, 513, 100003}) {
        std::vector<double> sums;
        for (int threads : {1, 2, 8})
            for (int repeat = 0; repeat < 3; ++repeat) {
                const ThreadLimit limit(threads);
                sums.push_back(parallel_sum(count, awkward_term));
            }
        for (double sum : sums)
            EXPECT_EQ(std::memcmp(&sum, &sums.front(), sizeof sum), 0) << count;
    }
}

TEST(ParallelSum, IsTheSum) {
    EXPECT_EQ(parallel_sum(0, awkward_term), 0);
    EXPECT_EQ(parallel_sum(10001, [](int i) { return static_cast<double>(i); }), 50005000.0);
}

TEST(ParallelFor, VisitsEveryIndexOnce) {
    for (int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        for (int count : {0, 1, 7, 8, 9, 5000}) {
            std::vector<int> visits(static_cast<std::size_t>(count), 0);
            parallel_for(count, 8, [&](int i) { ++visits[static_cast<std::size_t>(i)]; });
            EXPECT_EQ(std::count(visits.begin(), visits.end(), 1), count);
        }
    }
}

TEST(ParallelChunks, AreFixedAndCoverTheRange) {
    for (int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        std::vector<std::array<int, 2>> ranges(static_cast<std::size_t>(chunk_count(1000, 300)));
        parallel_chunks(1000, 300, [&](int chunk, int begin, int end) {
            ranges[static_cast<std::size_t>(chunk)] = {begin, end};
        });
        const std::vector<std::array<int, 2>> expected = {{0, 300}, {300, 600}, {600, 900}, {900, 1000}};
        EXPECT_EQ(ranges, expected);
    }
}

TEST(ThreadLimit, TakesTheProcessorsForZero) {
    EXPECT_GE(ThreadLimit(0).threads(), 1);
    EXPECT_EQ(ThreadLimit(3).threads(), 3);
}

TEST(ThreadLimit, IsTheThreadCountWhileItLives) {
    for (int threads : {1, 2}) {
        const ThreadLimit limit(threads);
        EXPECT_EQ(thread_count(), threads);
    }
}

} // namespace
} // namespace plisse
