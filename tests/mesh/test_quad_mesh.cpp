#include <plisse/mesh/quad_mesh.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <plisse/base/error.h>
#include <plisse/mesh/quad_connectivity.h>

#include <mesh/mesh_samples.h>

namespace plisse {
namespace {

const std::string two_by_one = "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nvt 0 0\n";

void expect_refusal(const std::string& text, const std::string& words, const std::string& name = "m.obj") {
    try {
        parse_quad_mesh(text, name);
        ADD_FAILURE() << "not refused: " << words;
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find(words), 0U) << error.what();
    }
}

TEST(QuadMesh, IsReadInOrder) {
    const QuadMesh mesh = parse_quad_mesh(two_by_one + "f 1/1 2/1 5/1 4/1\nf -5 -4 -1 -2\n", "m.obj");
    EXPECT_EQ(mesh.faces, (std::vector<Quad>{{0, 1, 4, 3}, {1, 2, 5, 4}}));
    EXPECT_EQ(mesh.vertex_count(), 6);
    EXPECT_EQ(mesh.positions(0, 5), 2);
    const TemporaryFolder folder;
    EXPECT_EQ(read_quad_mesh(folder.write("a.OBJ", two_by_one + "f 1 2 5 4\nf 2 3 6 5\n")).face_count(), 2);
}

TEST(QuadMesh, IsRefusedWithThePlace) {
    expect_refusal(two_by_one + "f 1 2 5 4\nf 2 3 6\n", "m.obj:9: a face with 3 corners");
    expect_refusal(two_by_one + "f 1 2 3 6 5 4\n", "m.obj:8: a face with 6 corners");
    expect_refusal(two_by_one + "f 1 2 5 4\nf 2 3 6 3\n", "m.obj:9: a face uses vertex 2 at (2, 0, 0) twice");
    expect_refusal(two_by_one + "f 1 2 5 4\nf 2 5 6 3\n", "m.obj:9: a face turns against its neighbour at the edge "
                                                          "from 1 at (1, 0, 0) to 4 at (1, 1, 0)");
    expect_refusal(two_by_one + "v 1 0 1\nv 1 1 1\nf 1 2 5 4\nf 2 3 6 5\nf 2 5 8 7\n", "m.obj:12: a third face");
    expect_refusal(two_by_one + "f 1 2 5 4\n", "m.obj: no face uses vertex 2 at (2, 0, 0)");
    expect_refusal(two_by_one + "f 1 2 5 4\nf 2 3 6 9\n", "m.obj:9: a face refers to vertex 9 of 6");
    expect_refusal(two_by_one, "m.obj: has no faces");
    expect_refusal("", "m.ply: is no OBJ file", "m.ply");
    EXPECT_THROW(read_quad_mesh("/no/such/file.obj"), InputError);
}

std::string fan(int n) {
    std::string text = "v 0 0 0\n";
    for (int k = 0; k < 2 * n; ++k)
        text +=
            "v " + std::to_string(std::cos(3.14159 * k / n)) + " " + std::to_string(std::sin(3.14159 * k / n)) + " 0\n";
    for (int k = 0; k < n; ++k)
        text += "f 1 " + std::to_string(2 + 2 * k) + " " + std::to_string(3 + 2 * k) + " " +
                std::to_string(2 + (2 * k + 2) % (2 * n)) + "\n";
    return text;
}

TEST(QuadMesh, TakesValences3To8) {
    for (int n = 3; n <= 8; ++n)
        EXPECT_EQ(parse_quad_mesh(fan(n), "m.obj").face_count(), n);
    expect_refusal(fan(9), "m.obj: 9 faces meet in vertex 0 at (0, 0, 0)");
    expect_refusal("v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3 4\nf 1 4 5 2\n",
                   "m.obj: 2 faces meet in vertex 0");
    expect_refusal("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0 0\nv -1 -1 0\nv 0 -1 0\nf 1 2 3 4\nf 1 5 6 7\n",
                   "m.obj: surfaces touch in vertex 0 at (0, 0, 0)");
}

TEST(QuadMesh, SheetFacesUpward) {
    const QuadMesh sheet = quad_sheet({2, 0.9}, {4, 3});
    ASSERT_EQ(sheet.vertex_count(), 20);
    ASSERT_EQ(sheet.face_count(), 12);
    for (const Quad& f : sheet.faces) {
        const Vec3 u = sheet.positions.col(f[1]) - sheet.positions.col(f[0]);
        const Vec3 v = sheet.positions.col(f[3]) - sheet.positions.col(f[0]);
        EXPECT_LT((u - Vec3(0, 0, 0.3)).norm(), 1e-15);
        EXPECT_LT((v - Vec3(0.5, 0, 0)).norm(), 1e-15);
    }
    EXPECT_EQ(sheet.positions.col(0), Vec3(-1, 0, -0.45));
    EXPECT_EQ(sheet.positions.col(19), Vec3(1, 0, 0.45));
}

TEST(QuadConnectivity, RelatesSides) {
    const QuadMesh sheet = quad_sheet({1, 1}, {3, 2});
    const QuadConnectivity c(sheet.vertex_count(), sheet.faces);
    EXPECT_EQ(c.edge_count(), 3 * 3 + 4 * 2);
    for (int h = 0; h < c.side_count(); ++h) {
        EXPECT_EQ(c.from(h), sheet.faces[static_cast<std::size_t>(h / 4)][static_cast<std::size_t>(h % 4)]);
        if (c.twin(h) < 0)
            continue;
        EXPECT_EQ(c.twin(c.twin(h)), h);
        EXPECT_EQ(c.from(c.twin(h)), c.to(h));
        EXPECT_EQ(c.edge(h), c.edge(c.twin(h)));
    }
    std::size_t corners = 0;
    for (int v = 0; v < sheet.vertex_count(); ++v) {
        const auto star = c.star(v);
        corners += star.size();
        for (std::size_t k = 0; k < star.size(); ++k) {
            EXPECT_EQ(c.from(star[k]), v);
            if (k > 0) { // counter-clockwise
                EXPECT_EQ(c.to(star[k]), c.from(QuadConnectivity::previous(star[k - 1])));
            }
        }
        EXPECT_EQ(c.is_boundary_vertex(v), star.size() < 4);
    }
    EXPECT_EQ(corners, 4 * sheet.faces.size());
}

} // namespace
} // namespace plisse
