#include <plisse/linalg/coloring.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include <plisse/base/random.h>

namespace plisse {
namespace {

using Elements = std::vector<std::vector<int>>;

Elements random_elements(int count, int vertex_count, int most_vertices) {
    Random random(5);
    Elements elements;
    for (int e = 0; e < count; ++e) {
        std::set<int> vertices;
        const int size = 1 + random.below(most_vertices);
        while (static_cast<int>(vertices.size()) < size)
            vertices.insert(random.below(vertex_count));
        elements.emplace_back(vertices.begin(), vertices.end());
    }
    return elements;
}

Coloring color(const Elements& elements, int vertex_count) {
    return color_elements(static_cast<int>(elements.size()), vertex_count,
                          [&](int e) { return std::span<const int>(elements[static_cast<std::size_t>(e)]); });
}

void expect_proper(const Elements& elements, int vertex_count) {
    const Coloring coloring = color(elements, vertex_count);
    std::vector<int> seen(elements.size(), 0);
    for (int c = 0; c < coloring.color_count(); ++c) {
        std::vector<bool> used(static_cast<std::size_t>(vertex_count), false);
        EXPECT_FALSE(coloring.elements(c).empty());
        EXPECT_TRUE(std::is_sorted(coloring.elements(c).begin(), coloring.elements(c).end()));
        for (int e : coloring.elements(c)) {
            ++seen[static_cast<std::size_t>(e)];
            for (int v : elements[static_cast<std::size_t>(e)]) {
                EXPECT_FALSE(used[static_cast<std::size_t>(v)]) << "colour " << c << " meets vertex " << v << " twice";
                used[static_cast<std::size_t>(v)] = true;
            }
        }
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
}

TEST(Coloring, ElementsOfOneColorShareNoVertex) {
    expect_proper(random_elements(3000, 1000, 4), 1000);
}

TEST(Coloring, HoldsWithHundredsOfColors) {
    const Elements elements = random_elements(5000, 60, 12);
    expect_proper(elements, 60);
    EXPECT_GT(color(elements, 60).color_count(), 500);
}

TEST(Coloring, OfDisjointElementsNeedsOneColor) {
    const Coloring coloring = color({{0, 1}, {2, 3}, {4}}, 5);
    EXPECT_EQ(coloring.color_count(), 1);
    EXPECT_EQ(coloring.order, (std::vector<int>{0, 1, 2}));
}

TEST(Coloring, OfNothingIsEmpty) {
    EXPECT_EQ(color({}, 5).color_count(), 0);
    EXPECT_TRUE(color({}, 0).order.empty());
}

TEST(ColoredGroups, HoldEveryElementOnceAndShareNoVertexWithinAColor) {
    constexpr int vertex_count = 1000, group_size = 16;
    const Elements elements = random_elements(3000, vertex_count, 3);
    const ColoredGroups groups = color_groups(static_cast<int>(elements.size()), vertex_count, group_size, [&](int e) {
        return std::span<const int>(elements[static_cast<std::size_t>(e)]);
    });
    std::vector<int> seen(elements.size(), 0);
    for (int c = 0; c < groups.coloring.color_count(); ++c) {
        std::vector<int> user(vertex_count, -1);
        for (int g : groups.coloring.elements(c)) {
            EXPECT_FALSE(groups.group(g).empty());
            EXPECT_LE(groups.group(g).size(), static_cast<std::size_t>(group_size));
            for (int e : groups.group(g)) {
                ++seen[static_cast<std::size_t>(e)];
                for (int v : elements[static_cast<std::size_t>(e)]) {
                    int& of_vertex = user[static_cast<std::size_t>(v)];
                    EXPECT_TRUE(of_vertex == -1 || of_vertex == g);
                    of_vertex = g;
                }
            }
        }
    }
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
}

TEST(ColoredGroups, LieTogether) {
    constexpr int length = 320, group_size = 32;
    std::vector<std::array<int, 2>> chain;
    for (int e = 0; e < length; ++e)
        chain.push_back({(7 * e) % length, (7 * e + 1) % length}); // a ring, in a scattered order
    const ColoredGroups groups = color_groups(
        length, length, group_size, [&](int e) { return std::span<const int>(chain[static_cast<std::size_t>(e)]); });
    EXPECT_EQ(groups.group_starts.size(), 11u);
    EXPECT_LE(groups.coloring.color_count(), 3);
}

} // namespace
} // namespace plisse
