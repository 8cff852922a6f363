#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include <plisse/mesh/generate.h>
#include <plisse/mesh/sheet_graph.h>

namespace plisse {
namespace {

const std::vector<Face> two_triangles = {{0, 1, 2}, {2, 1, 3}};

TEST(Connectivity, TellsTheRelationsOfTwoTriangles) {
    const Connectivity c(5, two_triangles);
    EXPECT_EQ(c.vertex_count(), 5);
    EXPECT_EQ(c.face_count(), 2);
    EXPECT_EQ(c.edges(), (std::vector<Edge>{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}}));
    EXPECT_EQ(c.face_edges(), (std::vector<std::array<int, 3>>{{0, 2, 1}, {2, 3, 4}}));
    const std::vector<std::vector<int>> edge_faces = {{0}, {0}, {0, 1}, {1}, {1}},
                                        opposite = {{2}, {1}, {0, 3}, {2}, {1}};
    for (int e = 0; e < 5; ++e) {
        EXPECT_TRUE(std::ranges::equal(c.edge_faces(e), edge_faces[static_cast<std::size_t>(e)])) << e;
        EXPECT_TRUE(std::ranges::equal(c.opposite(e), opposite[static_cast<std::size_t>(e)])) << e;
    }
    EXPECT_EQ(c.vertex_faces(1).size(), 2u);
    EXPECT_EQ(c.vertex_faces(3).front(), 1);
    EXPECT_TRUE(c.vertex_faces(4).empty());
    EXPECT_TRUE(c.is_boundary_edge(0));
    EXPECT_FALSE(c.is_boundary_edge(2));
    EXPECT_TRUE(c.non_manifold_edges().empty());
}

TEST(Connectivity, ListsAllFacesOfAnEdge) {
    const std::vector<Face> fins = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {1, 0, 5}};
    const Connectivity c(6, fins);
    EXPECT_EQ(c.non_manifold_edges(), std::vector<int>{0});
    EXPECT_TRUE(std::ranges::equal(c.edge_faces(0), std::vector<int>{0, 1, 2, 3}));
    EXPECT_TRUE(std::ranges::equal(c.opposite(0), std::vector<int>{2, 3, 4, 5}));
    EXPECT_TRUE(c.is_curve_edge(0));
    EXPECT_FALSE(c.is_boundary_edge(0));
}

TEST(Connectivity, OfNothingIsEmpty) {
    const Connectivity c(0, {});
    EXPECT_EQ(c.vertex_count(), 0);
    EXPECT_EQ(c.edge_count(), 0);
    EXPECT_EQ(Connectivity().vertex_count(), 0);
}

/// Each stored relation against what the face list alone says.
TEST(Connectivity, AgreesWithTheFaceListOfAWholeMesh) {
    GeneratorOptions options;
    options.shape = GeneratorShape::annulus;
    const TriangleMesh mesh = generate_mesh(options);
    const Connectivity c(mesh.vertex_count(), mesh.faces);
    std::map<Edge, std::set<int>> faces_of_edge;
    std::map<int, std::set<int>> faces_of_vertex;
    for (int f = 0; f < mesh.face_count(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const Face& face = mesh.faces[static_cast<std::size_t>(f)];
            const Edge edge = {std::min(face[k], face[(k + 1) % 3]), std::max(face[k], face[(k + 1) % 3])};
            faces_of_edge[edge].insert(f);
            faces_of_vertex[face[k]].insert(f);
            EXPECT_EQ(c.edges()[static_cast<std::size_t>(c.face_edges()[static_cast<std::size_t>(f)][k])], edge);
        }
    ASSERT_EQ(c.edges().size(), faces_of_edge.size());
    for (std::size_t e = 0; e < c.edges().size(); ++e) {
        std::set<int> faces;
        const auto sides = c.edge_faces(static_cast<int>(e));
        for (std::size_t side = 0; side < sides.size(); ++side) {
            const int f = sides[side];
            const int apex = c.opposite(static_cast<int>(e))[side];
            faces.insert(f);
            const Face& face = mesh.faces[static_cast<std::size_t>(f)];
            EXPECT_EQ(apex + c.edges()[e][0] + c.edges()[e][1], face[0] + face[1] + face[2]);
        }
        EXPECT_EQ(faces, faces_of_edge.at(c.edges()[e]));
    }
    for (int v = 0; v < c.vertex_count(); ++v) {
        const auto faces = c.vertex_faces(v);
        EXPECT_TRUE(std::is_sorted(faces.begin(), faces.end()));
        EXPECT_EQ(std::set<int>(faces.begin(), faces.end()), faces_of_vertex[v]);
    }
}

TEST(BoundaryLoops, RunWithTheSurfaceOnTheLeftFromTheLowestVertex) {
    const Connectivity c(4, two_triangles);
    EXPECT_EQ(boundary_loops(c, two_triangles), (std::vector<std::vector<int>>{{0, 1, 3, 2}}));
}

TEST(BoundaryLoops, AreTwoOnAnAnnulusAndNoneOnASphere) {
    GeneratorOptions options;
    options.shape = GeneratorShape::annulus;
    options.edge_length = 0.1;
    const TriangleMesh annulus = generate_mesh(options);
    const auto loops = boundary_loops(Connectivity(annulus.vertex_count(), annulus.faces), annulus.faces);
    ASSERT_EQ(loops.size(), 2u);
    std::set<long> rims;
    for (const auto& loop : loops) {
        EXPECT_EQ(loop.front(), *std::min_element(loop.begin(), loop.end()));
        const double radius = annulus.positions.col(loop.front()).norm();
        for (int v : loop)
            EXPECT_NEAR(annulus.positions.col(v).norm(), radius, 1e-12);
        rims.insert(std::lround(100 * radius));
    }
    EXPECT_EQ(rims, (std::set<long>{25, 50}));
    options.shape = GeneratorShape::sphere;
    const TriangleMesh sphere = generate_mesh(options);
    EXPECT_TRUE(boundary_loops(Connectivity(sphere.vertex_count(), sphere.faces), sphere.faces).empty());
}

TEST(BoundaryPieces, AreTheLoopsOfAManifoldAndOneWhereTheBoundaryBranches) {
    EXPECT_EQ(boundary_pieces(Connectivity(4, two_triangles)), (std::vector<std::vector<int>>{{0, 1, 2, 3}}));
    const std::vector<Face> book = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {5, 6, 7}};
    EXPECT_EQ(boundary_pieces(Connectivity(8, book)), (std::vector<std::vector<int>>{{0, 1, 2, 3, 4}, {5, 6, 7}}));
}

TEST(SheetGraph, CountsSheetsCurvesAndCorners) {
    EXPECT_EQ(sheet_graph(Connectivity(4, two_triangles)), (SheetGraph{1, 1, 0}));
    // Three leaves at one edge: their borders and the edge run between its two ends.
    const std::vector<Face> book = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
    EXPECT_EQ(sheet_graph(Connectivity(5, book)), (SheetGraph{3, 4, 2}));
    // Around an edge of a fan of six stands a fin: it ends inside the sheet, which goes on around it.
    std::vector<Face> fin = {{0, 1, 7}};
    for (int k = 0; k < 6; ++k)
        fin.push_back({0, 1 + k, 1 + (k + 1) % 6});
    EXPECT_EQ(sheet_graph(Connectivity(8, fin)), (SheetGraph{2, 3, 2}));
}

TEST(Components, AreNumberedByTheirLowestVertex) {
    const std::vector<Face> faces = {{1, 6, 3}, {0, 4, 2}, {4, 2, 7}};
    EXPECT_EQ(components(9, faces), (std::vector<int>{0, 1, 0, 1, 0, -1, 1, 0, -1}));
}

} // namespace
} // namespace plisse
