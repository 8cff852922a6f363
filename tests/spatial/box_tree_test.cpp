#include <plisse/spatial/box_tree.h>

#include <gtest/gtest.h>

#include <set>

#include <plisse/base/random.h>

namespace plisse {
namespace {

std::vector<Box> random_boxes(Random& random, int count, double scale, const Vec3& shift) {
    std::vector<Box> boxes(static_cast<std::size_t>(count));
    for (Box& box : boxes) {
        const Vec3 at(random.uniform(), random.uniform(), random.uniform());
        box.include(scale * at + shift);
        box.include(scale * (at + 0.2 * Vec3(random.uniform(), random.uniform(), random.uniform())) + shift);
    }
    return boxes;
}

std::set<std::array<int, 2>> ordered(const std::vector<std::array<int, 2>>& pairs) {
    std::set<std::array<int, 2>> result;
    for (auto [i, j] : pairs)
        EXPECT_TRUE(result.insert({std::min(i, j), std::max(i, j)}).second) << "listed twice: " << i << " " << j;
    return result;
}

const auto accept_all = [](int, int) { return true; };
constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

void expect_pairs_of_brute_force(const BoxTree& tree, const std::vector<Box>& boxes) {
    OverlapPairs found;
    ASSERT_TRUE(found.find_within(tree, accept_all, no_limit));
    const auto pairs = ordered(found.pairs());
    std::size_t expected = 0;
    for (int i = 0; i < tree.size(); ++i)
        for (int j = i + 1; j < tree.size(); ++j)
            if (boxes[static_cast<std::size_t>(i)].overlaps(boxes[static_cast<std::size_t>(j)])) {
                ++expected;
                ASSERT_TRUE(pairs.contains({i, j}));
            }
    EXPECT_EQ(pairs.size(), expected);
}

TEST(BoxTree, FindsAllPairsAndNoOthers) {
    Random random(1);
    for (int count : {1, 2, 3, 4, 5, 8, 9, 17, 100, 301}) {
        const auto boxes = random_boxes(random, count, 1, Vec3::Zero());
        expect_pairs_of_brute_force(BoxTree(boxes), boxes);
    }
}

TEST(BoxTree, FindsAllPairsOnceRefitted) {
    Random random(2);
    BoxTree tree(random_boxes(random, 150, 1, Vec3::Zero()));
    for (double scale : {1e-3, 1.0, 1e3}) {
        const auto boxes = random_boxes(random, 150, scale, Vec3(0.1, -3, 7) * scale);
        tree.refit(boxes);
        expect_pairs_of_brute_force(tree, boxes);
    }
}

TEST(BoxTree, MissesNoTouchingBoxesFarFromTheOrigin) {
    Random random(3);
    std::vector<Box> boxes;
    for (int i = 0; i < 200; ++i) { // each box touches the next in one plane that floats cannot represent
        const Vec3 shift(1e6 + random.uniform(), 0, 0);
        const double plane = shift.x() + random.uniform();
        boxes.push_back({Vec3(shift.x() - 1, 10.0 * i, 0), Vec3(plane, 10.0 * i + 1, 1)});
        boxes.push_back({Vec3(plane, 10.0 * i, 0), Vec3(plane + 1, 10.0 * i + 1, 1)});
    }
    OverlapPairs found;
    ASSERT_TRUE(found.find_within(BoxTree(boxes), accept_all, no_limit));
    const auto pairs = ordered(found.pairs());
    for (int i = 0; i < 400; i += 2)
        EXPECT_TRUE(pairs.contains({i, i + 1}));
}

TEST(BoxTree, CrossQueryAndFilterAgreeWithBruteForce) {
    Random random(4);
    const auto left = random_boxes(random, 700, 1, Vec3::Zero()), right = random_boxes(random, 90, 1, Vec3::Zero());
    const auto accept = [](int i, int j) { return (i + j) % 3 != 0; };
    OverlapPairs found;
    ASSERT_TRUE(found.find_between(BoxTree(left), BoxTree(right), accept, no_limit));
    std::set<std::array<int, 2>> expected;
    for (int i = 0; i < 700; ++i)
        for (int j = 0; j < 90; ++j)
            if (accept(i, j) && left[static_cast<std::size_t>(i)].overlaps(right[static_cast<std::size_t>(j)]))
                expected.insert({i, j});
    EXPECT_EQ(std::set(found.pairs().begin(), found.pairs().end()), expected);
    EXPECT_EQ(found.pairs().size(), expected.size());
    EXPECT_TRUE(found.find_between(BoxTree(left), BoxTree(right), accept, expected.size()));
    EXPECT_FALSE(found.find_between(BoxTree(left), BoxTree(right), accept, expected.size() - 1));
    EXPECT_TRUE(found.pairs().empty());
}

TEST(BoxTree, SameOrderForAnyNumberOfThreads) {
    Random random(5);
    const auto boxes = random_boxes(random, 2000, 1, Vec3::Zero());
    const BoxTree tree(boxes);
    OverlapPairs one, two;
    {
        const ThreadLimit limit(1);
        ASSERT_TRUE(one.find_within(tree, accept_all, no_limit));
    }
    {
        const ThreadLimit limit(2);
        ASSERT_TRUE(two.find_within(tree, accept_all, no_limit));
    }
    EXPECT_EQ(one.pairs(), two.pairs());
}

TEST(BoxTree, Empty) {
    BoxTree tree{std::span<const Box>()};
    OverlapPairs found;
    EXPECT_TRUE(found.find_within(tree, accept_all, 0));
    tree.visit_overlaps(Box{Vec3::Zero(), Vec3::Ones()}, [](int) { FAIL(); });
}

} // namespace
} // namespace plisse
