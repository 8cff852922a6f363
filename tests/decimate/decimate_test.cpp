#include <plisse/decimate/decimate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <plisse/base/parallel.h>
#include <plisse/decimate/hierarchy_statistics.h>
#include <plisse/mesh/connectivity.h>
#include <plisse/spatial/intersections.h>

#include <decimate/test_meshes.h>

namespace plisse {
namespace {

using test::TestMesh;

DecimationOptions options_to(int coarsest, int levels = 3) {
    DecimationOptions options;
    options.levels = levels;
    options.coarsest_vertices = coarsest;
    return options;
}

bool same(const Hierarchy& a, const Hierarchy& b) {
    if (a.collapses.size() != b.collapses.size() || a.level_count() != b.level_count())
        return false;
    for (int l = 0; l < a.level_count(); ++l) {
        const HierarchyLevel &p = a.levels[l], &q = b.levels[l];
        if (p.rest != q.rest || p.faces != q.faces || p.vertex_ids != q.vertex_ids || p.batches != q.batches)
            return false;
        for (std::size_t v = 0; v < p.to_finest.size(); ++v)
            if (p.to_finest[v].face != q.to_finest[v].face || p.to_finest[v].weights != q.to_finest[v].weights)
                return false;
    }
    return true;
}

TEST(Decimate, gives_the_same_bits_again_and_for_any_thread_count) {
    const TestMesh mesh = test::scene();
    const auto run = [&](int threads) {
        const ThreadLimit limit(threads);
        return decimate(mesh.input(), options_to(100));
    };
    const Hierarchy first = run(1);
    EXPECT_TRUE(same(first, run(1)));
    EXPECT_TRUE(same(first, run(2)));
    DecimationOptions other = options_to(100);
    other.seed = 2;
    EXPECT_FALSE(same(first, decimate(mesh.input(), other)));
}

TEST(Decimate, sizes_fall_geometrically) {
    DecimationSummary summary;
    const Hierarchy hierarchy = decimate(test::sphere(30, 21).input(), options_to(40, 4), nullptr, &summary);
    EXPECT_EQ(summary.reached_vertices, (std::vector<int>{40, 100, 252, 632}));
    EXPECT_EQ(hierarchy.levels[1].rest.cols(), 100);
}

TEST(Decimate, one_level_or_a_mesh_small_enough_stays_as_it_is) {
    const TestMesh mesh = test::square(6);
    EXPECT_EQ(decimate(mesh.input(), options_to(5, 1)).levels.size(), 1u);
    const Hierarchy hierarchy = decimate(mesh.input(), options_to(1000));
    ASSERT_EQ(hierarchy.levels.size(), 3u);
    EXPECT_TRUE(hierarchy.collapses.empty());
    EXPECT_EQ(hierarchy.levels[0].faces, mesh.faces);
    EXPECT_EQ(hierarchy.levels[0].to_next.size(), mesh.points.size());
}

TEST(Decimate, says_so_when_it_cannot_go_on) {
    class Listener : public Context {
    public:
        void on_message(const std::string& message) override { messages.push_back(message); }
        std::vector<std::string> messages;
    };
    for (const TestMesh& mesh : {test::tetrahedron(), test::triangles(1), test::triangles(2)}) {
        Listener listener;
        DecimationSummary summary;
        const Hierarchy hierarchy = decimate(mesh.input(), options_to(1), &listener, &summary);
        EXPECT_TRUE(summary.ran_dry);
        EXPECT_TRUE(summary.topology_kept);
        EXPECT_EQ(summary.reached_vertices, std::vector<int>(3, mesh.count()));
        EXPECT_EQ(hierarchy.levels[0].faces, mesh.faces);
        EXPECT_EQ(listener.messages.size(), 1u);
    }
}

TEST(Decimate, spreads_levels_over_what_it_reached) {
    const TestMesh mesh = test::sphere(16, 11);
    DecimationSummary summary;
    decimate(mesh.input(), options_to(1, 3), nullptr, &summary);
    EXPECT_TRUE(summary.ran_dry);
    const double coarsest = summary.reached_vertices[0];
    EXPECT_GE(coarsest, 4);
    EXPECT_NEAR(summary.reached_vertices[1], std::sqrt(coarsest * mesh.count()), 1);
}

TEST(Decimate, a_cancelled_run_still_gives_a_complete_hierarchy) {
    Context context;
    context.cancel();
    const TestMesh mesh = test::sphere(12, 9);
    const Hierarchy hierarchy = decimate(mesh.input(), options_to(10), &context);
    EXPECT_EQ(hierarchy.levels.size(), 3u);
    EXPECT_EQ(hierarchy.levels[0].faces, mesh.faces);
}

TEST(Decimate, handles_keep_their_places_to_the_bit_and_their_names) {
    const TestMesh mesh = test::scene();
    const Hierarchy hierarchy = decimate(mesh.input(), options_to(90));
    for (const HierarchyLevel& level : hierarchy.levels) {
        std::array<int, 2> count{};
        for (std::size_t v = 0; v < level.label.size(); ++v) {
            if (level.label[v] < 0)
                continue;
            ++count[level.label[v]];
            const Vec3 place = level.rest.col(static_cast<Eigen::Index>(v));
            bool found = false;
            for (int w = 0; w < mesh.count(); ++w)
                found = found || (mesh.label[w] == level.label[v] && mesh.points[w] == place);
            EXPECT_TRUE(found);
        }
        EXPECT_GE(count[0], 3);
        EXPECT_GE(count[1], 3);
    }
    EXPECT_LT(std::count(hierarchy.levels[0].label.begin(), hierarchy.levels[0].label.end(), 0),
              std::count(mesh.label.begin(), mesh.label.end(), 0)); // dense handles coarsen
}

TEST(Decimate, corners_of_a_square_stay) {
    const TestMesh mesh = test::square(12, 0.2);
    const Hierarchy hierarchy = decimate(mesh.input(), options_to(12));
    const Positions& rest = hierarchy.levels[0].rest;
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)})
        EXPECT_EQ((rest.colwise() - corner).colwise().norm().minCoeff(), 0);
}

TEST(Decimate, frozen_parts_stay_and_do_not_count) {
    TestMesh mesh;
    mesh.append(test::curved_square(12), Vec3::Zero()).append(test::sphere(10, 7), Vec3(4, 0, 0));
    mesh.frozen = {0, 1};
    DecimationSummary summary;
    const Hierarchy hierarchy = decimate(mesh.input(), options_to(30), nullptr, &summary);
    EXPECT_EQ(summary.reached_vertices.front(), 30);
    const HierarchyLevel& coarse = hierarchy.levels[0];
    EXPECT_EQ(std::count(coarse.part.begin(), coarse.part.end(), 1), 72);
    for (int v = 169; v < mesh.count(); ++v) {
        const Anchor& anchor = coarse.to_finest[v];
        EXPECT_EQ(anchor.weights.maxCoeff(), 1);
        int corner = 0;
        anchor.weights.maxCoeff(&corner);
        EXPECT_EQ(coarse.vertex_ids[coarse.faces[anchor.face][corner]], v);
    }
}

TEST(Decimate, obstacles_shrink_by_the_same_ratio) {
    TestMesh mesh;
    mesh.append(test::curved_square(19), Vec3::Zero()) // 400
        .append(test::torus(20, 10), Vec3(4, 0, 0))    // 200
        .append(test::torus(30, 20), Vec3(8, 0, 0));   // 600
    DecimationOptions options = options_to(100);
    options.obstacle_part = {0, 1, 1};
    DecimationSummary summary;
    const Hierarchy hierarchy = decimate(mesh.input(), options, nullptr, &summary);
    EXPECT_EQ(summary.reached_vertices, (std::vector<int>{100, 200, 400}));
    const auto share = [&](int l, int part) {
        return std::count(hierarchy.levels[l].part.begin(), hierarchy.levels[l].part.end(), part);
    };
    EXPECT_NEAR(share(0, 1), 50, 2);
    EXPECT_NEAR(share(0, 2), 150, 2);
    EXPECT_NEAR(share(1, 1), 100, 2);
    EXPECT_NEAR(share(1, 2), 300, 2);
}

TEST(Decimate, obstacles_alone_are_counted) {
    DecimationOptions options = options_to(40);
    options.obstacle_part = {1};
    EXPECT_EQ(decimate(test::sphere(16, 11).input(), options).levels[0].rest.cols(), 40);
}

TEST(Decimate, vertices_without_faces_take_no_part) {
    TestMesh mesh = test::square(8, 0.2);
    mesh.points.insert(mesh.points.begin(), Vec3(7, 7, 7));
    for (Face& face : mesh.faces)
        for (int& v : face)
            ++v;
    mesh.part.clear();
    mesh.label.clear();
    mesh.finish();
    const Hierarchy hierarchy = decimate(mesh.input(), options_to(20));
    EXPECT_EQ(hierarchy.levels[0].rest.cols(), 20);
    EXPECT_EQ(hierarchy.finest().rest.cols(), mesh.count());
    for (int l = 0; l < 2; ++l)
        EXPECT_EQ(hierarchy.levels[l].to_finest[0].face, -1);
    EXPECT_EQ(hierarchy.levels[1].to_next[0].face, -1);
}

TEST(Decimate, faces_without_area_and_pinched_vertices_keep_their_neighbourhood) {
    TestMesh mesh = test::square(10, 0.2);
    mesh.points[60] = mesh.points[61];                         // two faces and an edge vanish
    mesh.faces.push_back({0, mesh.count(), mesh.count() + 1}); // touches the sheet in one vertex
    mesh.points.push_back({-1, 0, 0});
    mesh.points.push_back({-1, -1, 0});
    mesh.part.clear();
    mesh.label.clear();
    mesh.finish();
    DecimationSummary summary;
    const Hierarchy hierarchy = decimate(mesh.input(), options_to(45), nullptr, &summary);
    EXPECT_EQ(summary.location_errors, 0);
    EXPECT_TRUE(summary.topology_kept);
    const std::vector<int>& ids = hierarchy.levels[0].vertex_ids;
    for (int v : {0, 60, 61})
        EXPECT_TRUE(std::binary_search(ids.begin(), ids.end(), v));
    EXPECT_LT(ids.size(), mesh.points.size() / 2);
}

/// Two shells of a sphere, so near that coarse chords of the outer one would cut the inner one.
TestMesh two_shells() {
    TestMesh outer = test::sphere(30, 21), inner = outer;
    for (Vec3& point : inner.points)
        point *= 0.985;
    TestMesh mesh;
    return mesh.append(outer, Vec3::Zero()).append(inner, Vec3::Zero());
}

TEST(Decimate, near_layers_neither_cross_nor_touch) {
    const TestMesh mesh = two_shells();
    DecimationOptions options = options_to(400);
    const auto crossings = [](const Hierarchy& hierarchy) {
        return intersecting_pairs(hierarchy.levels[0].rest, hierarchy.levels[0].faces).size();
    };
    EXPECT_EQ(crossings(decimate(mesh.input(), options)), 0u);
    options.test_intersections = false;
    EXPECT_GT(crossings(decimate(mesh.input(), options)), 0u);
}

TEST(Decimate, two_obstacles_may_cross) {
    const TestMesh mesh = two_shells();
    DecimationOptions options = options_to(300);
    options.obstacle_part = {1, 1};
    DecimationSummary summary;
    decimate(mesh.input(), options, nullptr, &summary);
    EXPECT_EQ(summary.reached_vertices.front(), 300);
}

TEST(Decimate, parallel_layers_do_not_hinder_each_other) {
    TestMesh mesh;
    mesh.append(test::square(20, 0.25), Vec3::Zero()).append(test::square(20, 0.2), Vec3(0.01, 0.01, 1e-4));
    DecimationSummary summary;
    decimate(mesh.input(), options_to(80), nullptr, &summary);
    EXPECT_FALSE(summary.ran_dry);
    EXPECT_LT(summary.rejections[static_cast<std::size_t>(Rejection::gap)], 50);
}

TEST(Decimate, good_meshes_stay_good) {
    const Hierarchy hierarchy = decimate(test::curved_square(40).input(), options_to(200));
    for (const LevelStatistics& statistics : hierarchy_statistics(hierarchy))
        EXPECT_GT(statistics.mean_quality, 0.8);
}

} // namespace
} // namespace plisse
