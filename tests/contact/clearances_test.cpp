#include <plisse/contact/clearances.h>

#include <gtest/gtest.h>

#include <limits>

#include "contact/sheets.h"

namespace plisse {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Clearances, AreOneHeightForAllPairsOfParallelSheets) {
    const double height = 0.01;
    Scene scene;
    scene.append_sheet(5, [=](double u, double v) { return Vec3(u + 0.013, height, v + 0.021); });
    scene.append_sheet(
        7, [](double u, double v) { return Vec3(2 * u - .5, 0, 2 * v - .5); }, true);
    const CollisionMesh mesh = scene.mesh();
    const Clearances clearances(mesh, 3 * height);
    for (const int v : mesh.vertices)
        for (std::size_t f = 0; f < mesh.faces.size(); ++f)
            if (mesh.part[static_cast<std::size_t>(v)] == 0 &&
                mesh.part[static_cast<std::size_t>(mesh.faces[f][0])] == 1) {
                // However far apart the two are: as the sheet slides, they may meet.
                EXPECT_NEAR(clearances.between(StencilKind::point_triangle, {v, static_cast<int>(f)}), height, 1e-15);
            }
    for (std::size_t i = 0; i < mesh.edges.size(); ++i)
        for (std::size_t j = 0; j < mesh.edges.size(); ++j)
            if (mesh.part[static_cast<std::size_t>(mesh.edges[i][0])] == 0 &&
                mesh.part[static_cast<std::size_t>(mesh.edges[j][0])] == 1) {
                EXPECT_NEAR(clearances.between(StencilKind::edge_edge, {static_cast<int>(i), static_cast<int>(j)}),
                            height, 1e-15);
            }
}

TEST(Clearances, AreInfiniteBeyondWhatIsAskedFor) {
    Scene scene;
    scene.append_sheet(2, [](double u, double v) { return Vec3(u, 0.1, v); });
    scene.append_sheet(2, [](double u, double v) { return Vec3(u, 0, v); });
    const CollisionMesh mesh = scene.mesh();
    EXPECT_EQ(Clearances(mesh, 0.09).between(StencilKind::point_triangle, {0, 8}), infinity);
    EXPECT_NEAR(Clearances(mesh, 0.11).between(StencilKind::point_triangle, {0, 8}), 0.1, 1e-15);
}

} // namespace
} // namespace plisse
