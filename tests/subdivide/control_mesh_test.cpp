#include <plisse/subdivide/control_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>

#include <plisse/base/error.h>

#include "quad_samples.h"

namespace plisse {
namespace {

TEST(ControlMesh, SurroundsEveryDomainVertexWithFaces) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        const ControlMesh mesh = with_ghost_ring(quads).mesh;
        EXPECT_EQ(mesh.domain_vertex_count, quads.vertex_count()) << name;
        EXPECT_EQ(mesh.domain_face_count, quads.face_count()) << name;
        EXPECT_TRUE(std::equal(quads.faces.begin(), quads.faces.end(), mesh.faces.begin())) << name;
        const QuadConnectivity inner(quads.vertex_count(), quads.faces), all = mesh.connectivity();
        std::size_t corners = 0;
        for (int v = 0; v < mesh.domain_vertex_count; ++v) {
            EXPECT_FALSE(all.is_boundary_vertex(v)) << name;
            const auto star = all.star(v);
            corners += star.size();
            if (inner.is_boundary_vertex(v)) {
                EXPECT_EQ(star.size(), 4U) << name;
            }
        }
        std::size_t domain_corners = 0; // of all faces: no face hangs on otherwise
        for (const Quad& face : mesh.faces) {
            const auto count = std::count_if(face.begin(), face.end(), [&](int v) { return !mesh.is_ghost(v); });
            EXPECT_GT(count, 0) << name;
            domain_corners += static_cast<std::size_t>(count);
        }
        EXPECT_EQ(corners, domain_corners) << name;
    }
}

TEST(ControlMesh, CountsGhosts) {
    EXPECT_EQ(with_ghost_ring(flat_grid(4, 4)).mesh.vertex_count * 3, 147);
    EXPECT_EQ(with_ghost_ring(l_shape(4, 1)).mesh.vertex_count * 3, 144);
    EXPECT_EQ(with_ghost_ring(cubes({{0, 0, 0}})).mesh.ghost_count(), 0);
}

TEST(ControlMesh, ListsTheBoundaryWithTheSurfaceOnItsLeft) {
    const QuadMesh quads = l_shape(4, 1);
    const ControlMesh mesh = with_ghost_ring(quads).mesh;
    ASSERT_EQ(mesh.boundary.size(), 16U);
    for (const auto& [face, side] : mesh.boundary) {
        const Quad& f = quads.faces[static_cast<std::size_t>(face)];
        const Vec3 a = quads.positions.col(f[static_cast<std::size_t>(side)]);
        const Vec3 b = quads.positions.col(f[static_cast<std::size_t>((side + 1) % 4)]);
        const Vec3 outside = 0.5 * (a + b) + 0.5 * Vec3(b.y() - a.y(), a.x() - b.x(), 0);
        const bool is_outside =
            outside.minCoeff() < 0 || outside.maxCoeff() > 4 || (outside.x() > 3 && outside.y() > 3);
        EXPECT_TRUE(is_outside);
    }
}

/// Faces are rectangles, ghosts too.
TEST(ControlMesh, ContinuesGridsOfStraightLines) {
    for (bool uneven : {false, true})
        for (QuadMesh quads : {flat_grid(4, 3), flat_grid(1, 1), l_shape(4, 1), l_shape(5, uneven ? 1 : 2)}) {
            if (uneven)
                quads.positions.row(0) = quads.positions.row(0).unaryExpr([](double x) { return x * (1 + 0.1 * x); });
            const auto& [mesh, p] = with_ghost_ring(quads);
            for (const Quad& f : mesh.faces) {
                const Vec3 twist = p.col(f[0]) - p.col(f[1]) + p.col(f[2]) - p.col(f[3]);
                EXPECT_LT(twist.norm(), 1e-13);
                const Vec3 u = p.col(f[1]) - p.col(f[0]), v = p.col(f[3]) - p.col(f[0]);
                EXPECT_LT(std::abs(u.dot(v)), 1e-13);
                EXPECT_GT(u.cross(v).z(), 0.3);
                if (!uneven) {
                    EXPECT_NEAR(u.norm(), 1, 1e-13);
                    EXPECT_NEAR(v.norm(), 1, 1e-13);
                }
            }
        }
}

TEST(ControlMesh, KnowsWhereGhostsAre) {
    const ControlCage cage = with_ghost_ring(l_shape(4, 1));
    const std::vector<Ghost> ghosts = find_ghosts(cage.mesh);
    std::map<Ghost::Kind, int> counts;
    for (std::size_t i = 0; i < ghosts.size(); ++i) {
        ++counts[ghosts[i].kind];
        const Vec3 g = cage.positions.col(cage.mesh.domain_vertex_count + static_cast<int>(i));
        const Vec3 away = g - cage.positions.col(ghosts[i].vertex);
        EXPECT_NEAR(away.squaredNorm(), ghosts[i].kind == Ghost::Kind::edge ? 1 : 2, 1e-13);
    }
    EXPECT_EQ(counts[Ghost::Kind::reentrant], 1);
    EXPECT_EQ(counts[Ghost::Kind::corner], 5);
    EXPECT_EQ(counts[Ghost::Kind::edge], 18);
}

void expect_refusal(const QuadMesh& mesh, const std::string& words) {
    try {
        with_ghost_ring(mesh);
        ADD_FAILURE() << "not refused: " << words;
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
}

TEST(ControlMesh, RefusesBoundariesItCannotContinue) {
    expect_refusal(grid_cells(3, 3, [](int i, int j) { return i != 1 || j != 1; }), "one face wide");
    expect_refusal(grid_cells(3, 3, [](int i, int j) { return i != 1 || j == 0; }), "one face wide");
    QuadMesh open_fan = fan(5);
    open_fan.faces.pop_back();
    expect_refusal(open_fan, "4 faces meet on the boundary in vertex 0");
    QuadMesh half = fan(6);
    half.faces.resize(3);
    const QuadMesh used = {half.positions.leftCols(8), half.faces};
    expect_refusal(used, "no inner corner");
}

} // namespace
} // namespace plisse
