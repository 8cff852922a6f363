#include <plisse/contact/contact_options.h>

#include <gtest/gtest.h>

namespace plisse {
namespace {

ContactOptions options(double distance, double thickness, double enforced = 1) {
    ContactOptions options;
    options.distance = distance;
    options.thickness = thickness;
    options.enforced = enforced;
    return options;
}

void expect_range(const PairRange& range, double thickness, double least, double activation) {
    EXPECT_DOUBLE_EQ(range.thickness, thickness);
    EXPECT_DOUBLE_EQ(range.least, least);
    EXPECT_DOUBLE_EQ(range.activation, activation);
}

TEST(PairRange, WithoutThicknessRepelsFromHalfOfTheRestDistance) {
    for (const bool same_part : {false, true}) {
        expect_range(pair_range(options(1, 0), same_part, 5), 0, 0, 1);
        expect_range(pair_range(options(1, 0), same_part, 1), 0, 0, 0.5);
        expect_range(pair_range(options(1, 0), same_part, 0), 0, 0, 1); // touching at rest
    }
}

TEST(PairRange, OfOneBodyIsSilentAtRest) {
    expect_range(pair_range(options(1, 4), true, 10), 4, 4, 5);
    expect_range(pair_range(options(1, 4), true, 5), 2.5, 2.5, 3.5);
    expect_range(pair_range(options(1, 4), true, 1), 0.5, 0.5, 0.75);
}

TEST(PairRange, OfTwoBodiesKeepsTheWholeThickness) {
    expect_range(pair_range(options(1, 4), false, 10), 4, 4, 5);
    expect_range(pair_range(options(1, 4), false, 5), 4, 4, 4.5);
    expect_range(pair_range(options(1, 4), false, 4.01), 4, 4, 4.1); // almost touching: it has to repel over something
    expect_range(pair_range(options(1, 4), false, 3), 4, 4, 5);      // too near
}

TEST(PairRange, EnforcesAShareOfTheThickness) {
    expect_range(pair_range(options(1, 4, 0.25), false, 10), 4, 1, 5);
    expect_range(pair_range(options(1, 4, 0), true, 1), 0.5, 0, 0.75);
}

TEST(ContactOptions, KeepsAShareOfTheRoomAPairHasButNotMoreThanTheContactDistance) {
    const ContactOptions near_or_far = options(0.5, 4); // keeps a tenth
    EXPECT_DOUBLE_EQ(near_or_far.kept_distance(6, 4), 4.2);
    EXPECT_DOUBLE_EQ(near_or_far.kept_distance(4, 4), 4);
    EXPECT_DOUBLE_EQ(near_or_far.kept_distance(100, 4), 4.5);
    EXPECT_DOUBLE_EQ(near_or_far.kept_distance(2, 0), 0.2);
}

} // namespace
} // namespace plisse
