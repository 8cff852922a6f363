#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <plisse/picture/normals.h>
#include <plisse/picture/occlusion.h>
#include <plisse/picture/shadow.h>

#include "shapes.h"

namespace plisse {
namespace {

TEST(CornerNormals, OfASpherePointOutwards) {
    const TriangleMesh mesh = shapes::sphere(2, 40);
    const auto normals = corner_normals(mesh.positions, mesh.faces, 55);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 outward = mesh.positions.col(mesh.faces[f][k]) / 2;
            if (std::abs(outward.y()) < 0.9) {
                EXPECT_GT(normals[f][k].dot(outward.cast<float>()), 0.997f);
            }
        }
}

TEST(CornerNormals, KeepTheEdgesOfABox) {
    const TriangleMesh mesh = shapes::cube();
    const auto normals = corner_normals(mesh.positions, mesh.faces, 55);
    for (const CornerNormals& corners : normals)
        for (const Eigen::Vector3f& normal : corners)
            EXPECT_FLOAT_EQ(normal.cwiseAbs().maxCoeff(), 1);
}

TEST(CornerNormals, OfDegenerateFacesAreZeroAndSpoilNoOthers) {
    TriangleMesh mesh = shapes::square(1);
    mesh.faces.push_back({0, 1, 1});
    const auto normals = corner_normals(mesh.positions, mesh.faces, 55);
    EXPECT_EQ(normals.back()[0], Eigen::Vector3f::Zero());
    EXPECT_EQ(normals.front()[0], Eigen::Vector3f::UnitZ());
}

TEST(ShadowMap, DarkensWhatLiesBehindAnotherSurface) {
    TriangleMesh mesh = shapes::square(4); // wide wall at z = 0
    mesh.positions *= 2;
    TriangleMesh screen = shapes::square(4); // small one before it
    screen.positions *= 0.5;
    screen.positions.row(2).setConstant(1);
    shapes::append(mesh, screen);
    const Vec3 light = Vec3::UnitZ();
    const ShadowMap shadows(mesh.positions, mesh.faces, light, mesh.positions);
    EXPECT_EQ(shadows.light_at({0, 0, 0}, light), 0);
    EXPECT_NEAR(shadows.light_at({1.5, 0.3, 0}, light), 1, 1e-5);
    EXPECT_NEAR(shadows.light_at({0, 0, 1}, light), 1, 1e-5);
    EXPECT_EQ(shadows.light_at({50, 0, 0}, light), 1);
    const float rim = shadows.light_at({0.5, 0, 0}, light);
    EXPECT_GT(rim, 0.2f);
    EXPECT_LT(rim, 0.8f);
}

TEST(ShadowMap, LeavesASlantedSurfaceLit) {
    const TriangleMesh mesh = shapes::square(20);
    for (double tilt : {0.0, 0.5, 1.0, 1.2}) {
        const Vec3 light{std::sin(tilt), 0, std::cos(tilt)};
        const ShadowMap shadows(mesh.positions, mesh.faces, light, mesh.positions);
        for (double x : {-0.7, -0.123, 0.4})
            EXPECT_NEAR(shadows.light_at({x, 0.21, 0}, Vec3::UnitZ()), 1, 1e-5) << tilt << " " << x;
    }
}

/// What a camera on the z axis sees of a floor z = 0 with a wall that rises from x = 0.
SurfaceBuffer floor_buffer(const Camera& camera, double wall_height) {
    SurfaceBuffer buffer;
    buffer.width = buffer.height = 80;
    for (int y = 0; y < buffer.height; ++y)
        for (int x = 0; x < buffer.width; ++x) {
            const Vec3 ray = camera.ray(x + 0.5, y + 0.5, buffer.width, buffer.height);
            const double top = camera.eye.z() - wall_height;
            const bool on_wall = camera.eye.x() + top * ray.x() < 0;
            buffer.depth.push_back(static_cast<float>(on_wall ? top : camera.eye.z()));
            buffer.normals.push_back(Eigen::Vector3f::UnitZ());
        }
    return buffer;
}

TEST(AmbientOpenness, IsOneOnAPlaneAndLessInACorner) {
    Camera camera;
    camera.eye = {0.6, 0, 10};
    camera.half_height = 0.2;
    for (float open : ambient_openness(floor_buffer(camera, 0), camera, 0.5))
        EXPECT_FLOAT_EQ(open, 1);
    const SurfaceBuffer step = floor_buffer(camera, 0.2);
    const std::vector<float> openness = ambient_openness(step, camera, 0.5);
    const int wall_end = 27; // (0 - 0.6) / 0.05 + 40, less what perspective adds
    EXPECT_LT(openness[step.index(wall_end + 2, 40)], 0.8f);
    EXPECT_FLOAT_EQ(openness[step.index(70, 40)], 1);
    EXPECT_FLOAT_EQ(openness[step.index(10, 40)], 1);
}

TEST(AmbientOpenness, IsOneWhereNothingIsSeen) {
    Camera camera;
    SurfaceBuffer buffer;
    buffer.width = buffer.height = 8;
    buffer.depth.assign(64, std::numeric_limits<float>::infinity());
    buffer.normals.assign(64, Eigen::Vector3f::Zero());
    for (float open : ambient_openness(buffer, camera, 1))
        EXPECT_EQ(open, 1);
}

} // namespace
} // namespace plisse
