#include <plisse/spatial/hash_grid.h>

#include <gtest/gtest.h>

#include <map>

#include <plisse/base/random.h>

namespace plisse {
namespace {

Box random_box(Random& random, double most_size) {
    const Vec3 low(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2));
    const double size = most_size * random.uniform();
    return {low, low + Vec3(size * random.uniform(), size * random.uniform(), size * random.uniform())};
}

std::vector<int> brute_force(const std::map<int, Box>& boxes, const Box& query) {
    std::vector<int> ids;
    for (const auto& [id, box] : boxes)
        if (box.overlaps(query))
            ids.push_back(id);
    return ids;
}

TEST(HashGrid, agrees_with_brute_force_while_boxes_come_move_and_go) {
    Random random(7);
    constexpr int capacity = 300;
    HashGrid grid(0.3, capacity);
    std::map<int, Box> boxes;
    std::vector<int> found;
    for (int step = 0; step < 5000; ++step) {
        const int id = random.below(capacity);
        const Box box = random_box(random, step % 50 == 0 ? 4.0 : 0.5); // a few fill more cells than the grid takes
        if (!boxes.contains(id))
            grid.insert(id, boxes[id] = box);
        else if (random.below(3) == 0) {
            grid.remove(id);
            boxes.erase(id);
        } else
            grid.update(id, boxes[id] = box);
        ASSERT_EQ(grid.size(), static_cast<int>(boxes.size()));
        const Box query = random_box(random, step % 70 == 0 ? 5.0 : 0.8);
        grid.query(query, found);
        ASSERT_EQ(found, brute_force(boxes, query)) << "step " << step;
    }
}

TEST(HashGrid, finds_boxes_that_only_touch_and_flat_ones) {
    HashGrid grid(0.25, 4);
    grid.insert(0, {Vec3(0, 0, 0), Vec3(1, 1, 0)});
    grid.insert(1, {Vec3(1, 1, 0), Vec3(2, 2, 0)});
    grid.insert(2, {Vec3(5, 5, 5), Vec3(5, 5, 5)});
    std::vector<int> found;
    grid.query({Vec3(1, 1, 0), Vec3(1, 1, 0)}, found);
    EXPECT_EQ(found, (std::vector<int>{0, 1}));
    grid.query({Vec3(4, 4, 4), Vec3(5, 5, 5)}, found);
    EXPECT_EQ(found, (std::vector<int>{2}));
}

TEST(HashGrid, keeps_an_empty_box_but_never_finds_it) {
    HashGrid grid(1, 2);
    grid.insert(0, Box{});
    EXPECT_TRUE(grid.contains(0));
    std::vector<int> found{3};
    grid.query({Vec3(-1, -1, -1), Vec3(1, 1, 1)}, found);
    EXPECT_TRUE(found.empty());
    grid.update(0, {Vec3(0, 0, 0), Vec3(1, 1, 1)});
    grid.query({Vec3(-1, -1, -1), Vec3(1, 1, 1)}, found);
    EXPECT_EQ(found, (std::vector<int>{0}));
}

} // namespace
} // namespace plisse
