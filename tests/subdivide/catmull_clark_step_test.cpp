#include <plisse/subdivide/catmull_clark_step.h>

#include <gtest/gtest.h>

#include "quad_samples.h"

namespace plisse {
namespace {

Vec3 mean(const Quad& face, const Positions& p) {
    Vec3 sum = Vec3::Zero();
    for (int v : face)
        sum += p.col(v) / 4;
    return sum;
}

/// RMTR equations 5.12 to 5.14, on all vertices that have faces all around.
TEST(CatmullClarkStep, FollowsTheRules) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        const ControlMesh coarse = with_ghost_ring(quads).mesh;
        const QuadConnectivity connectivity = coarse.connectivity();
        const CatmullClarkStep step = catmull_clark_step(coarse);
        const Positions p = random_positions(coarse.vertex_count);
        const Positions fine = p * step.weights.transpose();
        const auto face_point = [&](int side) { return mean(coarse.faces[static_cast<std::size_t>(side / 4)], p); };
        for (int v = 0; v < step.fine.vertex_count; ++v) {
            const auto& [kind, number] = step.origin[static_cast<std::size_t>(v)];
            Vec3 expected = Vec3::Zero();
            if (kind == VertexOrigin::Kind::face) {
                expected = face_point(4 * number);
                EXPECT_EQ(step.face_child[static_cast<std::size_t>(number)], v);
            } else if (kind == VertexOrigin::Kind::edge) {
                const int side = connectivity.edge_side(number);
                ASSERT_GE(connectivity.twin(side), 0) << name;
                expected = (p.col(connectivity.from(side)) + p.col(connectivity.to(side)) + face_point(side) +
                            face_point(connectivity.twin(side))) /
                           4;
                EXPECT_EQ(step.edge_child[static_cast<std::size_t>(number)], v);
            } else {
                const std::vector<int> star = connectivity.star(number);
                const auto n = static_cast<double>(star.size());
                ASSERT_FALSE(connectivity.is_boundary_vertex(number)) << name;
                expected = (n - 2) / n * p.col(number);
                for (int h : star)
                    expected += (p.col(connectivity.to(h)) + face_point(h)) / (n * n);
                EXPECT_EQ(step.vertex_child[static_cast<std::size_t>(number)], v);
            }
            EXPECT_LT((fine.col(v) - expected).norm(), 1e-15) << name << ", vertex " << v;
        }
    }
}

TEST(CatmullClarkStep, KeepsOneRingOfGhosts) {
    for (const auto& [name, quads, ordinary] : quad_samples()) {
        ControlMesh mesh = with_ghost_ring(quads).mesh;
        for (int level = 0; level < 2; ++level) {
            const CatmullClarkStep step = catmull_clark_step(mesh);
            EXPECT_EQ(step.fine.domain_face_count, 4 * mesh.domain_face_count) << name;
            QuadMesh domain;
            domain.positions = random_positions(step.fine.domain_vertex_count);
            domain.faces.assign(step.fine.faces.begin(), step.fine.faces.begin() + step.fine.domain_face_count);
            const QuadConnectivity inner(step.fine.domain_vertex_count, domain.faces);
            const QuadConnectivity all = step.fine.connectivity();
            for (int v = 0; v < step.fine.domain_vertex_count; ++v) {
                EXPECT_FALSE(all.is_boundary_vertex(v)) << name;
                if (inner.is_boundary_vertex(v)) {
                    EXPECT_EQ(all.star(v).size(), 4U) << name;
                }
            }
            mesh = step.fine;
        }
    }
}

TEST(CatmullClarkStep, HasTheUnknownsOfThePaper) {
    std::vector<int> square, reentrant;
    ControlMesh a = with_ghost_ring(flat_grid(4, 4)).mesh, b = with_ghost_ring(l_shape(4, 1)).mesh;
    for (int level = 0; level < 6; ++level) {
        square.push_back(3 * a.vertex_count);
        reentrant.push_back(3 * b.vertex_count);
        if (level < 5) {
            a = catmull_clark_step(a).fine;
            b = catmull_clark_step(b).fine;
        }
    }
    EXPECT_EQ(square, (std::vector<int>{147, 363, 1083, 3675, 13467, 51483}));
    EXPECT_EQ(reentrant, (std::vector<int>{144, 351, 1035, 3483, 12699, 48411}));
}

/// A flat even grid stays one, ghosts included, and children lie where their parent and quarter say.
TEST(CatmullClarkStep, HalvesAnEvenGrid) {
    for (const QuadMesh& quads : {flat_grid(4, 3), l_shape(4, 1), l_shape(5, 2)}) {
        const auto& [mesh, p] = with_ghost_ring(quads);
        const CatmullClarkStep step = catmull_clark_step(mesh);
        const Positions fine = p * step.weights.transpose();
        for (std::size_t f = 0; f < step.fine.faces.size(); ++f) {
            const Quad& face = step.fine.faces[f];
            const Vec3 u = fine.col(face[1]) - fine.col(face[0]), v = fine.col(face[3]) - fine.col(face[0]);
            EXPECT_NEAR(u.norm(), 0.5, 1e-14);
            EXPECT_NEAR(v.norm(), 0.5, 1e-14);
            EXPECT_NEAR(u.cross(v).z(), 0.25, 1e-14);
            if (static_cast<int>(f) >= step.fine.domain_face_count)
                continue;
            const Quad& parent = mesh.faces[f / 4];
            EXPECT_LT((fine.col(face[f % 4]) - p.col(parent[f % 4])).norm(), 1e-14);
            EXPECT_LT((2 * u - (p.col(parent[1]) - p.col(parent[0]))).norm(), 1e-14); // runs like it
        }
        for (std::size_t b = 0; b < step.fine.boundary.size(); ++b) {
            const auto ends = [](const ControlMesh& m, const BoundarySide& s) {
                const Quad& f = m.faces[static_cast<std::size_t>(s.face)];
                return std::array<int, 2>{f[static_cast<std::size_t>(s.side)],
                                          f[static_cast<std::size_t>((s.side + 1) % 4)]};
            };
            const auto half = ends(step.fine, step.fine.boundary[b]);
            const auto whole = ends(mesh, mesh.boundary[b / 2]);
            const Vec3 step_along = 0.5 * (p.col(whole[1]) - p.col(whole[0]));
            for (int end : {0, 1})
                EXPECT_LT((fine.col(half[static_cast<std::size_t>(end)]) - p.col(whole[0]) -
                           (static_cast<double>(b % 2) + end) * step_along)
                              .norm(),
                          1e-14);
        }
        EXPECT_EQ(step.fine.boundary.size(), 2 * mesh.boundary.size());
    }
}

} // namespace
} // namespace plisse
