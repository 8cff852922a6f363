#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <plisse/base/random.h>
#include <plisse/decimate/collapse_queue.h>
#include <plisse/decimate/joint_flattening.h>
#include <plisse/decimate/quadric.h>
#include <plisse/decimate/triangle_distance.h>

#include <decimate/test_meshes.h>

namespace plisse {
namespace {

Vec3 random_point(Random& random, double size = 1) {
    return Vec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
}

double normal_deviate(Random& random) {
    double sum = -6;
    for (int k = 0; k < 12; ++k)
        sum += random.uniform();
    return sum;
}

TEST(Quadric, is_the_expected_squared_distance_to_an_uncertain_plane) {
    Random random(1);
    const Vec3 normal = Vec3(1, 2, -1).normalized(), point(0.3, -0.2, 0.5), x(0.9, 0.1, 0.4);
    constexpr double normal_sigma = 0.2, point_sigma = 0.3;
    double sum = 0;
    constexpr int samples = 200000;
    const auto deviate = [&](double sigma) {
        return Vec3(sigma * normal_deviate(random), sigma * normal_deviate(random), sigma * normal_deviate(random));
    };
    for (int s = 0; s < samples; ++s) {
        const double distance = (normal + deviate(normal_sigma)).dot(x - point - deviate(point_sigma));
        sum += distance * distance;
    }
    const Quadric quadric = probabilistic_plane_quadric(normal, point, 2.5, normal_sigma, point_sigma);
    EXPECT_NEAR(quadric(x), 2.5 * sum / samples, 0.01 * quadric(x));
}

TEST(Quadric, three_planes_meet_in_its_minimiser) {
    Quadric quadric = plane_quadric(Vec3(1, 0, 0), Vec3(1, 7, 7), 1);
    quadric += plane_quadric(Vec3(0, 1, 0), Vec3(7, 2, 7), 3);
    quadric += plane_quadric(Vec3(0, 0.6, 0.8), Vec3(7, 2, 3), 2);
    EXPECT_LT((quadric.minimiser() - Vec3(1, 2, 3)).norm(), 1e-13);
    EXPECT_NEAR(quadric(quadric.minimiser()), 0, 1e-12);
}

TEST(TriangleDistance, agrees_with_dense_samples) {
    Random random(2);
    for (int trial = 0; trial < 60; ++trial) {
        Triangle a, b;
        const Vec3 offset(2.2, random.uniform(-1, 1), random.uniform(-1, 1)); // so that they do not intersect
        for (std::size_t k = 0; k < 3; ++k) {
            a[k] = random_point(random);
            b[k] = random_point(random) + offset;
        }
        double least = 1e300;
        constexpr int n = 24;
        const auto sample = [&](const Triangle& t, int u, int v) -> Vec3 {
            return t[0] + (t[1] - t[0]) * u / n + (t[2] - t[0]) * v / n;
        };
        for (int u = 0; u <= n; ++u)
            for (int v = 0; u + v <= n; ++v)
                for (int s = 0; s <= n; ++s)
                    for (int t = 0; s + t <= n; ++t)
                        least = std::min(least, (sample(a, u, v) - sample(b, s, t)).norm());
        const double distance = std::sqrt(triangle_distance_squared(a, b));
        EXPECT_LE(distance, least + 1e-12);
        EXPECT_GE(distance, least - 0.2);
        EXPECT_NEAR(triangle_distance_squared(b, a), triangle_distance_squared(a, b), 1e-12);
    }
}

TEST(TriangleDistance, an_inner_point_and_crossing_edges_count) {
    const Triangle floor{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
    EXPECT_NEAR(triangle_distance_squared(floor, {Vec3(1, 1, 0.5), Vec3(1, 1, 2), Vec3(2, 1, 2)}), 0.25, 1e-15);
    EXPECT_NEAR(triangle_distance_squared(floor, {Vec3(1, -0.3, 1), Vec3(1, -0.3, -1), Vec3(1, -2, 0)}), 0.09, 1e-15);
}

TEST(TriangleDistance, surely_apart_is_never_wrong_and_mostly_right) {
    Random random(3);
    int apart = 0, shown = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        Triangle a, b;
        const Vec3 offset = random_point(random, 3);
        for (std::size_t k = 0; k < 3; ++k) {
            a[k] = random_point(random);
            b[k] = random_point(random) + offset;
        }
        const auto normal = [](const Triangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]).normalized(); };
        const double gap = 0.5 * random.uniform();
        const bool shows = surely_apart(a, normal(a), b, normal(b), gap);
        const double distance = std::sqrt(triangle_distance_squared(a, b));
        apart += distance > gap;
        shown += shows;
        ASSERT_TRUE(!shows || distance > gap);
    }
    EXPECT_GT(shown, 0.8 * apart);
}

TEST(CollapseQueue, parks_wakes_and_forgets) {
    CollapseQueue queue(2, 6);
    queue.add({0, 1}, 0, 3.0);
    queue.add({1, 2}, 0, 1.0);
    queue.add({2, 3}, 0, 1.0);
    queue.add({4, 5}, 1, 0.0);
    EXPECT_EQ(queue.pop(0), 1); // the tie goes to the lower number
    queue.park(1);
    EXPECT_EQ(queue.pop(0), 2);
    queue.park(2);
    queue.wake(1);
    EXPECT_EQ(queue.pop(0), 1);
    queue.park(1);
    queue.remove_vertex(1);
    queue.wake(2);
    EXPECT_EQ(queue.pop(0), 2);
    EXPECT_EQ(queue.pop(0), -1);
    EXPECT_EQ(queue.pop(1), 3);
}

/// Flattening a flat patch must give the patch back, scaled and turned so that the edge is the unit segment.
TEST(JointFlattening, gives_a_flat_patch_back) {
    test::TestMesh mesh = test::square(6, 0.2);
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    const int i = 3 * 7 + 3, j = 3 * 7 + 4, k = mesh.count();
    const Vec3 merged = 0.4 * mesh.points[i] + 0.6 * mesh.points[j] + Vec3(0, 0.01, 0);
    Positions rest(3, k + 1);
    rest << mesh.rest, merged;
    const Positions turned = turn.toRotationMatrix() * rest;
    const DynamicFaces faces(mesh.faces, k + 1);
    Patch patch;
    patch.gather(faces, i, j, k);
    JointFlattening flattening;
    Chart chart;
    ASSERT_TRUE(flattening.flatten(patch, faces, turned, Alias::none, chart));
    const Vec2 origin = rest.col(i).head<2>(), along = rest.col(j).head<2>() - origin;
    const auto expected = [&](int v) -> Vec2 {
        const Vec2 d = rest.col(v).head<2>() - origin;
        return Vec2(d.dot(along), along.x() * d.y() - along.y() * d.x()) / along.squaredNorm();
    };
    EXPECT_LT((chart.k - expected(k)).norm(), 1e-12);
    EXPECT_EQ(patch.places, patch.ring);
    for (std::size_t n = 0; n < patch.places.size(); ++n)
        EXPECT_LT((chart.ring[n] - expected(patch.places[n])).norm(), 1e-12);
}

TEST(JointFlattening, keeps_a_straight_boundary_straight) {
    test::TestMesh mesh = test::square(6, 0.2);
    const int i = 2, j = 3, k = mesh.count();
    Positions rest(3, k + 1);
    rest << mesh.rest, 0.5 * (mesh.points[i] + mesh.points[j]);
    const DynamicFaces faces(mesh.faces, k + 1);
    Patch patch;
    patch.gather(faces, i, j, k);
    ASSERT_TRUE(patch.is_curve_edge());
    EXPECT_EQ(patch.beyond_i, 1);
    EXPECT_EQ(patch.beyond_j, 4);
    JointFlattening flattening;
    Chart chart;
    ASSERT_TRUE(flattening.flatten(patch, faces, rest, Alias::none, chart));
    ASSERT_TRUE(flattening.flatten(patch, faces, rest, Alias::j, chart));
    EXPECT_EQ(chart.k, Vec2(1, 0));
    EXPECT_EQ(chart.alias, Alias::j);
    EXPECT_EQ(chart.ring[patch.place(0, 1)].y(), 0);
}

/// Along a joint, every sheet has a plane of its own but the same place for what is on the curve.
TEST(JointFlattening, lays_a_joint_on_one_line_in_all_sheets) {
    const test::TestMesh mesh = test::crossed_sheets(6);
    const auto at_height = [&](int n) { // vertices of the joint
        const double z = 2.0 * n / 12;
        const Vec3 place(0.1 * std::sin(2 * z), 0.1 * std::cos(3 * z), z);
        for (int v = 0; v < mesh.count(); ++v)
            if ((mesh.points[v] - place).norm() < 1e-9)
                return v;
        return -1;
    };
    const int i = at_height(5), j = at_height(6), k = mesh.count();
    Positions rest(3, k + 1);
    rest << mesh.rest, 0.5 * (mesh.points[i] + mesh.points[j]);
    const DynamicFaces faces(mesh.faces, k + 1);
    Patch patch;
    patch.gather(faces, i, j, k);
    EXPECT_EQ(patch.dead_faces.size(), 4U);
    EXPECT_EQ(patch.sheet_count, 4);
    EXPECT_EQ(patch.beyond_i, at_height(4));
    EXPECT_EQ(patch.beyond_j, at_height(7));
    JointFlattening flattening;
    Chart chart;
    for (Alias alias : {Alias::none, Alias::i, Alias::j}) {
        ASSERT_TRUE(flattening.flatten(patch, faces, rest, alias, chart));
        for (int sheet = 0; sheet < 4; ++sheet) {
            if (chart.alias != Alias::i)
                EXPECT_EQ(chart.ring[patch.place(sheet, patch.beyond_i)], chart.ring[patch.place(0, patch.beyond_i)]);
            if (chart.alias != Alias::j)
                EXPECT_EQ(chart.ring[patch.place(sheet, patch.beyond_j)], chart.ring[patch.place(0, patch.beyond_j)]);
        }
    }
}

TEST(DynamicFaces, tells_rings_and_curves) {
    const test::TestMesh mesh = test::square(2);
    const DynamicFaces faces(mesh.faces, mesh.count() + 3);
    std::vector<int> ring;
    faces.ring(0, ring);
    EXPECT_EQ(ring, (std::vector<int>{1, 3, 4}));
    EXPECT_TRUE(faces.is_curve_edge(0, 1));
    EXPECT_FALSE(faces.is_curve_edge(0, 4));
    EXPECT_FALSE(faces.has_vertex(mesh.count()));
}

} // namespace
} // namespace plisse
