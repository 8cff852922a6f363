#include <plisse/contact/collision_mesh.h>

#include <gtest/gtest.h>

#include <numeric>

#include "contact/sheets.h"

namespace plisse {
namespace {

TEST(CollisionMesh, AreasOfTwoTriangles) {
    Positions rest(3, 5);
    rest << 0, 2, 0, 2, 9, //
        0, 0, 2, 2, 9,     //
        0, 0, 0, 0, 9;
    const CollisionMesh mesh(rest, {{0, 1, 2}, {1, 3, 2}}, {0, 0, 0, 0, 0}, {0});
    EXPECT_EQ(mesh.edges, (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}}));
    EXPECT_EQ(mesh.vertices, (std::vector<int>{0, 1, 2, 3})); // no face uses vertex 4
    EXPECT_EQ(mesh.face_area, (std::vector<double>{2, 2}));
    const std::vector<double> edge_area = {2. / 3, 2. / 3, 4. / 3, 2. / 3, 2. / 3};
    const std::vector<double> vertex_area = {2. / 3, 4. / 3, 4. / 3, 2. / 3, 0};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_DOUBLE_EQ(mesh.edge_area[i], edge_area[i]);
        EXPECT_DOUBLE_EQ(mesh.vertex_area[i], vertex_area[i]);
    }
}

TEST(CollisionMesh, AreasSumToTheSurface) {
    Scene scene;
    scene.append_sheet(7, [](double u, double v) { return Vec3(2 * u, 0, 3 * v); });
    const CollisionMesh mesh = scene.mesh();
    const auto sum = [](const std::vector<double>& areas) { return std::accumulate(areas.begin(), areas.end(), 0.0); };
    EXPECT_NEAR(sum(mesh.face_area), 6, 1e-13);
    EXPECT_NEAR(sum(mesh.vertex_area), 6, 1e-13);
    EXPECT_NEAR(sum(mesh.edge_area), 6, 1e-13);
}

} // namespace
} // namespace plisse
