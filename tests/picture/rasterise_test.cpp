#include <plisse/picture/rasterise.h>

#include <cmath>
#include <mutex>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <plisse/base/parallel.h>
#include <plisse/base/random.h>

#include "shapes.h"

namespace plisse {
namespace {

/// The whole picture's samples, rows from the top.
std::vector<int> all_faces(std::span<const ScreenTriangle> triangles, int width, int height, int samples) {
    std::vector<int> faces(static_cast<std::size_t>(width * height * samples * samples), -2);
    rasterise(triangles, width, height, samples, [&](const SampleBand& band) {
        const auto start = static_cast<std::ptrdiff_t>(band.first_row) * samples * band.sample_width();
        std::copy(band.face.begin(), band.face.end(), faces.begin() + start);
    });
    return faces;
}

/// Distance along the ray at which it meets a triangle, and how far inside it does (negative: outside).
struct Meeting {
    double distance, inside;
};

Meeting meet(const Vec3& origin, const Vec3& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
    Mat3 system;
    system << b - a, c - a, -ray;
    const Vec3 solution = system.partialPivLu().solve(origin - a);
    return {solution.z(), std::min({solution.x(), solution.y(), 1 - solution.x() - solution.y()})};
}

/// The nearest face along a ray, by trying all; nothing when the answer hangs on round-off.
std::optional<int> nearest_face(const TriangleMesh& mesh, const Camera& camera, const Vec3& ray) {
    int nearest = -1;
    double distance = 1e30;
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        const Meeting meeting =
            meet(camera.eye, ray, mesh.positions.col(a), mesh.positions.col(b), mesh.positions.col(c));
        if (std::abs(meeting.inside) < 1e-6 || std::abs(meeting.distance - camera.near) < 1e-6)
            return std::nullopt;
        if (meeting.inside < 0 || meeting.distance < camera.near)
            continue;
        if (std::abs(meeting.distance - distance) < 1e-4 * distance)
            return std::nullopt;
        if (meeting.distance < distance) {
            distance = meeting.distance;
            nearest = static_cast<int>(f);
        }
    }
    return nearest;
}

void expect_same_as_brute_force(const TriangleMesh& mesh, const Camera& camera, int width, int height, int samples) {
    const auto triangles = project(mesh.positions, mesh.faces, camera, width, height);
    const std::vector<int> faces = all_faces(triangles, width, height, samples);
    int decided = 0;
    for (int y = 0; y < height * samples; ++y)
        for (int x = 0; x < width * samples; ++x) {
            const Vec3 ray = camera.ray((x + 0.5) / samples, (y + 0.5) / samples, width, height);
            const auto expected = nearest_face(mesh, camera, ray);
            if (!expected)
                continue;
            ++decided;
            ASSERT_EQ(faces[static_cast<std::size_t>(y * width * samples + x)], *expected) << x << " " << y;
        }
    EXPECT_GT(decided, width * height * samples * samples * 9 / 10);
}

TriangleMesh triangle_soup(int count, std::uint64_t seed) {
    Random random(seed);
    TriangleMesh mesh;
    mesh.positions.resize(3, 3 * count);
    for (int i = 0; i < count; ++i) {
        Vec3 middle;
        for (double& value : middle)
            value = random.uniform(-1, 1);
        for (int k = 0; k < 3; ++k) {
            for (int axis = 0; axis < 3; ++axis)
                mesh.positions(axis, 3 * i + k) = middle[axis] + random.uniform(-0.6, 0.6);
        }
        mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

TEST(Rasterise, AgreesWithRayCasting) {
    const TriangleMesh mesh = triangle_soup(40, 3);
    expect_same_as_brute_force(mesh, fit_camera(mesh.positions, {20, 30, 1}, 1.5), 45, 30, 2);
}

TEST(Rasterise, AgreesWithRayCastingFromWithinTheMesh) {
    const TriangleMesh mesh = triangle_soup(40, 4);
    Camera camera;
    camera.eye = {0.05, 0.02, 0.3};
    camera.half_height = 1;
    camera.near = 0.02;
    expect_same_as_brute_force(mesh, camera, 40, 40, 1);
}

TEST(Rasterise, LeavesNoHolesBetweenTrianglesThatShareAnEdge) {
    Random random(11);
    TriangleMesh mesh = shapes::square(40);
    for (Eigen::Index i = 0; i < mesh.positions.cols(); ++i)
        if (mesh.positions.col(i).cwiseAbs().maxCoeff() < 0.99)
            mesh.positions.col(i) += 0.01 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    Camera camera;
    camera.eye = {0, 0, 2};
    camera.half_height = 0.4;
    for (int face : all_faces(project(mesh.positions, mesh.faces, camera, 97, 97), 97, 97, 3))
        ASSERT_GE(face, 0);
}

TEST(Rasterise, LeavesNoHolesOnSamplesThatLieExactlyOnEdges) {
    // Grid lines and diagonals pass through the samples of one per pixel.
    const TriangleMesh grid = shapes::grid(8, 8, [](double u, double v) { return Vec3{8 * u + 0.5, 8 * v + 0.5, 1}; });
    std::vector<ScreenTriangle> triangles;
    for (std::size_t f = 0; f < grid.faces.size(); ++f) {
        const auto& [a, b, c] = grid.faces[f];
        triangles.push_back(
            {{grid.positions.col(a), grid.positions.col(b), grid.positions.col(c)}, static_cast<int>(f)});
    }
    for (int face : all_faces(triangles, 9, 9, 1))
        EXPECT_GE(face, 0);
}

TEST(Rasterise, PassesOverBadTriangles) {
    TriangleMesh mesh = shapes::square(2);
    mesh.faces = {{0, 0, 1}, {0, 1, 2}, {0, 1, 4}}; // a point, a line, and one that will not be finite
    mesh.positions(1, 4) = std::nan("");
    Camera camera;
    camera.eye = {0, 0, 3};
    for (int face : all_faces(project(mesh.positions, mesh.faces, camera, 20, 20), 20, 20, 2))
        EXPECT_EQ(face, -1);
}

TEST(Rasterise, GivesTheSameSamplesForAnyNumberOfThreads) {
    const TriangleMesh mesh = triangle_soup(300, 5);
    const auto triangles = project(mesh.positions, mesh.faces, fit_camera(mesh.positions, {}, 1), 150, 150);
    std::vector<std::vector<int>> results;
    for (int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        results.push_back(all_faces(triangles, 150, 150, 3));
    }
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

} // namespace
} // namespace plisse
