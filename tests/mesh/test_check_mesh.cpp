#include <gtest/gtest.h>

#include <plisse/mesh/check_mesh.h>
#include <plisse/mesh/generate.h>

namespace plisse {
namespace {

TriangleMesh mesh_of(const std::vector<Vec3>& points, std::vector<Face> faces) {
    TriangleMesh mesh;
    mesh.positions.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        mesh.positions.col(static_cast<Eigen::Index>(i)) = points[i];
    mesh.faces = std::move(faces);
    return mesh;
}

const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                  {0, 0, 1}, {3, 3, 3}, {4, 3, 3}, {3, 4, 3}};

TEST(CheckMesh, FindsNothingWrongWithAGoodMesh) {
    const TriangleMesh mesh = mesh_of(points, {{0, 1, 2}, {2, 1, 3}, {5, 6, 7}});
    const MeshCheck check = check_mesh(mesh);
    EXPECT_TRUE(check.usable());
    EXPECT_TRUE(describe_findings(check, mesh).empty());
    EXPECT_EQ(check.vertices, 8);
    EXPECT_EQ(check.faces, 3);
    EXPECT_EQ(check.components, 2);
    EXPECT_EQ(check.boundary_loops, 2);
    EXPECT_EQ(check.unreferenced_vertices, 1);
    EXPECT_EQ(check.euler_characteristic, 2);
}

TEST(CheckMesh, AllowsAnEdgeOfThreeFacesWhicheverWayTheyTurn) {
    const TriangleMesh mesh = mesh_of(points, {{0, 1, 2}, {0, 1, 4}, {0, 1, 5}});
    const MeshCheck check = check_mesh(mesh);
    EXPECT_EQ(check.non_manifold_edges, (std::vector<Edge>{{0, 1}}));
    EXPECT_EQ(check.sheets, 3);
    EXPECT_TRUE(check.inconsistent_edges.empty());
    EXPECT_TRUE(check.non_manifold_vertices.empty());
    EXPECT_TRUE(check.usable());
    EXPECT_TRUE(describe_findings(check, mesh).empty());
}

TEST(CheckMesh, FindsAPinchBesideAnEdgeOfThreeFaces) {
    const MeshCheck check = check_mesh(mesh_of(points, {{0, 1, 2}, {1, 0, 4}, {0, 1, 5}, {0, 6, 7}}));
    EXPECT_EQ(check.non_manifold_vertices, std::vector<int>{0});
    EXPECT_FALSE(check.usable());
}

TEST(CheckMesh, FindsFacesThatTurnOppositeWays) {
    const MeshCheck check = check_mesh(mesh_of(points, {{0, 1, 2}, {1, 2, 3}}));
    EXPECT_EQ(check.inconsistent_edges, (std::vector<Edge>{{1, 2}}));
    EXPECT_FALSE(check.usable());
}

TEST(CheckMesh, FindsAVertexWhereSurfacesTouch) {
    const TriangleMesh mesh = mesh_of(points, {{3, 1, 2}, {3, 5, 6}});
    const MeshCheck check = check_mesh(mesh);
    EXPECT_EQ(check.non_manifold_vertices, std::vector<int>{3});
    EXPECT_FALSE(check.usable());
    EXPECT_EQ(describe_findings(check, mesh),
              std::vector<std::string>{"1 vertex where surfaces touch in a point: 3 at (1, 1, 0)"});
}

TEST(CheckMesh, FindsDegenerateFacesOfAnySize) {
    for (double scale : {1e-150, 1.0, 1e150}) {
        TriangleMesh mesh = mesh_of({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {1, 0, 0}, {1, 1e-10, 0}},
                                    {{0, 1, 3}, {0, 1, 2}, {3, 3, 0}, {0, 3, 4}});
        mesh.positions *= scale;
        EXPECT_EQ(check_mesh(mesh).degenerate_faces, (std::vector<int>{1, 2})) << scale;
    }
}

TEST(CheckMesh, FindsDuplicatesWhicheverWayTheyTurn) {
    const MeshCheck check = check_mesh(mesh_of(points, {{0, 1, 2}, {5, 6, 7}, {1, 2, 0}, {2, 1, 0}}));
    EXPECT_EQ(check.duplicate_faces, (std::vector<int>{2, 3}));
    EXPECT_FALSE(check.usable());
}

TEST(CheckMesh, FindsIntersectingFacesOfDifferentParts) {
    const TriangleMesh mesh =
        mesh_of({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {.5, .5, -1}, {.5, .5, 1}, {3, 3, 0}}, {{0, 1, 2}, {3, 4, 5}});
    const MeshCheck check = check_mesh(mesh);
    EXPECT_EQ(check.intersecting_faces, (std::vector<std::array<int, 2>>{{0, 1}}));
    EXPECT_EQ(describe_findings(check, mesh),
              std::vector<std::string>{"1 pair of intersecting faces: 0 and 1 at (0, 0, 0)"});
}

TEST(CheckMesh, SaysTheFirstFewOfMany) {
    std::vector<Face> faces;
    for (int k = 0; k < 5; ++k)
        faces.push_back({0, 1, 1});
    const TriangleMesh mesh = mesh_of(points, faces);
    const auto sentences = describe_findings(check_mesh(mesh), mesh);
    ASSERT_EQ(sentences.size(), 2u);
    EXPECT_EQ(sentences[0], "5 degenerate faces: 0 at (0, 0, 0), 1 at (0, 0, 0), 2 at (0, 0, 0) and 2 more");
}

TEST(CheckMesh, RefusesAMeshWithoutFaces) {
    const TriangleMesh mesh = mesh_of(points, {});
    EXPECT_FALSE(check_mesh(mesh).usable());
    EXPECT_EQ(describe_findings(check_mesh(mesh), mesh), std::vector<std::string>{"no faces"});
    EXPECT_FALSE(check_mesh(TriangleMesh()).usable());
}

} // namespace
} // namespace plisse
