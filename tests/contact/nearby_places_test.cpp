#include <plisse/contact/nearby_places.h>

#include <gtest/gtest.h>

#include <plisse/contact/candidates.h>

#include "contact/sheets.h"

namespace plisse {
namespace {

/// A point and a surface of one part each, the point last.
struct Pointed {
    Pointed(const Positions& surface, const std::vector<Face>& faces, const Vec3& point) {
        scene.append(surface, faces, false);
        scene.append(point, {}, false);
        mesh = scene.mesh();
    }
    /// What the point repels within `reach`.
    std::vector<NearPlace> places(double reach) const {
        std::vector<NearTriangle> near;
        for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
            const auto& [a, b, c] = mesh.faces[f];
            const std::array<int, 4> vertices = {static_cast<int>(scene.x.cols()) - 1, a, b, c};
            const Separation separation = separate_point_triangle(gather(scene.x, vertices));
            if (separation.squared_distance < reach * reach)
                near.push_back({static_cast<int>(f), vertices, {0, 0, reach}, separation});
        }
        std::vector<NearPlace> result;
        if (!near.empty())
            find_nearby_places(mesh, scene.x, near, result);
        return result;
    }

    Scene scene;
    CollisionMesh mesh;
};

/// A fan of six triangles around vertex 0, its rim at height y.
Pointed fan(double y, const Vec3& point) {
    Positions x(3, 7);
    std::vector<Face> faces;
    x.col(0).setZero();
    for (int k = 0; k < 6; ++k) {
        x.col(k + 1) = Vec3(std::cos(k * M_PI / 3), y, std::sin(k * M_PI / 3));
        faces.push_back({0, 1 + (k + 1) % 6, 1 + k});
    }
    return {x, faces, point};
}

TEST(NearbyPlaces, OfAFlatPatchAreTheFaceBelow) {
    Random random(1);
    for (int trial = 0; trial < 200; ++trial) {
        const double reach = random.uniform(0.05, 0.6), height = random.uniform(0, 1) * reach;
        const double radius = random.uniform(0, 0.8), angle = random.uniform(0, 2 * M_PI);
        const Pointed flat = fan(0, Vec3(radius * std::cos(angle), height, radius * std::sin(angle)));
        const auto places = flat.places(reach);
        ASSERT_EQ(places.size(), 1U);
        EXPECT_EQ(places[0].count, 1);
        EXPECT_NEAR(places[0].separation.squared_distance, height * height, 1e-14);
        EXPECT_GE(places[0].corners[2], 0); // a face
    }
}

TEST(NearbyPlaces, AreAnEdgeAcrossARidgeAndAVertexAcrossAPeak) {
    const auto peak = fan(-1, Vec3(0.01, 0.3, 0.02)).places(0.5);
    ASSERT_EQ(peak.size(), 1U);
    EXPECT_EQ(peak[0].count, 1);
    EXPECT_EQ(peak[0].corners, (std::array{0, -1, -1}));

    Positions roof(3, 4); // faces 0 1 2 and 1 0 3 fall off from the edge 0 1
    roof << 0, 0, 1, -1, 0, 0, -1, -1, 0, 1, 0.5, 0.5;
    const auto ridge = Pointed(roof, {{0, 1, 2}, {1, 0, 3}}, Vec3(0.02, 0.3, 0.4)).places(0.5);
    ASSERT_EQ(ridge.size(), 1U);
    EXPECT_EQ(ridge[0].count, 1);
    EXPECT_EQ(ridge[0].corners, (std::array{1, 0, -1}));
}

TEST(NearbyPlaces, OfAFoldAreBothFacesLessTheirEdge) {
    Positions valley(3, 4);
    valley << 0, 0, 1, -1, 0, 0, 1, 1, 0, 1, 0.5, 0.5;
    const auto places = Pointed(valley, {{0, 1, 2}, {1, 0, 3}}, Vec3(0, 0.2, 0.5)).places(0.5);
    ASSERT_EQ(places.size(), 3U);
    int sum = 0;
    for (const NearPlace& place : places) {
        sum += place.count;
        EXPECT_NEAR(place.separation.squared_distance, place.count > 0 ? 0.02 : 0.04, 1e-14);
    }
    EXPECT_EQ(sum, 1);
}

/// On a floor with a wall below it, and above one of its own.
TEST(NearbyPlaces, OfAJointAreTheFaceBelowOrBothFacesLessTheEdge) {
    Positions x(3, 5);
    x << 0, 0, 1, -1, 0, /**/ 0, 0, 0, 0, -1, /**/ 0, 1, 0.5, 0.5, 0.5;
    const std::vector<Face> faces = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
    for (double side : {0.02, -0.02, 0.0}) {
        const auto above = Pointed(x, faces, Vec3(side, 0.2, 0.5)).places(0.5);
        ASSERT_EQ(above.size(), 1U);
        EXPECT_EQ(above[0].count, 1);
        EXPECT_NEAR(above[0].separation.squared_distance, 0.04, 1e-14);
    }
    int sum = 0;
    for (const NearPlace& place : Pointed(x, faces, Vec3(0.1, -0.1, 0.5)).places(0.5)) {
        sum += place.count;
        EXPECT_NEAR(place.separation.squared_distance, place.count > 0 ? 0.01 : 0.02, 1e-14);
    }
    EXPECT_EQ(sum, 1);
}

TEST(NearbyPlaces, AreOneBesideTheRimToo) {
    const Pointed beside = fan(0, Vec3(1.1, 0.1, 0.05));
    const auto places = beside.places(0.5);
    ASSERT_EQ(places.size(), 1U);
    EXPECT_EQ(places[0].count, 1);
    EXPECT_EQ(places[0].corners, (std::array{1, -1, -1}));
}

} // namespace
} // namespace plisse
