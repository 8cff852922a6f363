#include <plisse/base/random.h>

#include <gtest/gtest.h>

namespace plisse {
namespace {

TEST(Random, GivesThePublishedNumbers) {
    // SplitMix64 from seed 0, and from seed 1234567: widely published check values.
    Random zero(0);
    EXPECT_EQ(zero.bits(), 0xe220a8397b1dcdafULL);
    EXPECT_EQ(zero.bits(), 0x6e789e6aa1b965f4ULL);
    EXPECT_EQ(zero.bits(), 0x06c45d188009454fULL);
    Random other(1234567);
    EXPECT_EQ(other.bits(), 6457827717110365317ULL);
    EXPECT_EQ(other.bits(), 3203168211198807973ULL);
}

TEST(Random, IsUniformAndWithinItsRange) {
    Random random(5);
    double sum = 0;
    for (int i = 0; i < 100000; ++i) {
        const double value = random.uniform(-1, 3);
        ASSERT_GE(value, -1);
        ASSERT_LT(value, 3);
        sum += value;
    }
    EXPECT_NEAR(sum / 100000, 1, 0.02);
    int counts[7] = {};
    for (int i = 0; i < 70000; ++i)
        ++counts[random.below(7)];
    for (int count : counts)
        EXPECT_NEAR(count, 10000, 500);
}

TEST(Random, RepeatsForTheSameSeedOnly) {
    Random a(9), b(9), c(10);
    EXPECT_EQ(a.uniform(), b.uniform());
    EXPECT_NE(a.bits(), c.bits());
}

} // namespace
} // namespace plisse
