#include <gtest/gtest.h>

#include <malloc.h>

#include <plisse/contact/candidates.h>

#include "contact/sheets.h"

namespace plisse {
namespace {

constexpr auto pt = StencilKind::point_triangle;
constexpr auto ee = StencilKind::edge_edge;

std::size_t bytes_in_use() {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

/// Layers of n x n cells, a contact distance of a tenth of a cell apart.
Scene layers(int n) {
    Scene scene;
    for (int layer = 0; layer < 3; ++layer)
        scene.append_sheet(n, [=](double u, double v) { return Vec3(u, 0.1 * layer / n, v); });
    return scene;
}

int most_pairs(const Candidates& candidates) {
    return std::max(candidates.size(pt), candidates.size(ee));
}

TEST(BroadPhaseMemory, PairsAroundAreAFixedNumberForEachVertex) {
    for (const int n : {10, 20, 40, 80}) {
        const Scene scene = layers(n);
        const CollisionMesh mesh = scene.mesh();
        Candidates candidates(mesh, 0.1 / n, true);
        candidates.find_around(scene.x);
        EXPECT_GT(most_pairs(candidates), 10 * scene.x.cols());
        EXPECT_LT(most_pairs(candidates), 60 * scene.x.cols());
    }
}

/// However far and wildly everything moves, pairs stay within the documented multiple of the vertices or of the pairs
/// around the start, and memory in proportion to that.
TEST(BroadPhaseMemory, IsBoundedHoweverFarThingsMove) {
    constexpr int n = 40;
    const Scene scene = layers(n);
    const CollisionMesh mesh = scene.mesh();
    Random random(1);
    for (const double length : {1e-3, 0.1, 10.0}) {
        const Positions wild = jittered(0 * scene.x, random, length);
        Positions fall = 0 * scene.x;
        fall.colwise() = length * Vec3(1, 0.3, -2).normalized(); // as one, so that all boxes overlap along the way
        for (const Positions& d : {wild, fall}) {
            const std::size_t before = bytes_in_use();
            Candidates candidates(mesh, 0.1 / n, true);
            candidates.find_around(scene.x);
            const int limit = std::max(100 * static_cast<int>(scene.x.cols()), 3 * most_pairs(candidates));
            const double share = candidates.find_along(scene.x, d, 1);
            EXPECT_GT(share, 0);
            EXPECT_LE(most_pairs(candidates), limit);
            EXPECT_TRUE(length < 1 || share < 1);
            EXPECT_LT(bytes_in_use() - before, 100U * static_cast<std::size_t>(limit)); // 75 seen
        }
    }
}

} // namespace
} // namespace plisse
