#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <Eigen/Geometry>

#include <plisse/decimate/decimate.h>
#include <plisse/decimate/dynamic_faces.h>
#include <plisse/decimate/hierarchy_statistics.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/mesh/connectivity.h>
#include <plisse/spatial/intersections.h>

#include <decimate/test_meshes.h>

namespace plisse {
namespace {

using test::TestMesh;

struct Case {
    const char* name;
    std::function<TestMesh()> make;
    int coarsest;
    double largest_map_error; ///< of the diagonal
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << c.name;
}

/// Properties every hierarchy has, on meshes of all kinds.
class HierarchyProperties : public testing::TestWithParam<Case> {
protected:
    void SetUp() override {
        mesh_ = GetParam().make();
        DecimationOptions options;
        options.levels = 4;
        options.coarsest_vertices = GetParam().coarsest;
        hierarchy_ = decimate(mesh_.input(), options, nullptr, &summary_);
    }

    const HierarchyLevel& level(int l) const { return hierarchy_.levels[l]; }
    int coarse_count() const { return hierarchy_.level_count() - 1; }

    TestMesh mesh_;
    Hierarchy hierarchy_;
    DecimationSummary summary_;
};

/// Those with a number of faces: 1 is the boundary.
std::set<Edge> curve_edges(const HierarchyLevel& level, std::size_t faces) {
    const Connectivity connectivity(static_cast<int>(level.rest.cols()), level.faces);
    std::set<Edge> edges;
    for (int e = 0; e < connectivity.edge_count(); ++e)
        if (connectivity.edge_faces(e).size() == faces)
            edges.insert(connectivity.edges()[e]);
    return edges;
}

std::set<int> ends_of(const std::set<Edge>& edges) {
    std::set<int> vertices;
    for (const Edge& edge : edges)
        vertices.insert(edge.begin(), edge.end());
    return vertices;
}

bool on_curve(const Anchor& anchor, const HierarchyLevel& coarse, const std::set<Edge>& edges,
              const std::set<int>& vertices) {
    std::vector<int> support;
    for (int c = 0; c < 3; ++c)
        if (anchor.weights[c] != 0)
            support.push_back(coarse.faces[anchor.face][c]);
    std::sort(support.begin(), support.end());
    return support.size() == 1   ? vertices.contains(support[0])
           : support.size() == 2 ? edges.contains({support[0], support[1]})
                                 : false;
}

void expect_sound(const std::vector<Anchor>& anchors, const HierarchyLevel& coarse, const HierarchyLevel& fine) {
    ASSERT_EQ(static_cast<Eigen::Index>(anchors.size()), fine.rest.cols());
    for (std::size_t v = 0; v < anchors.size(); ++v) {
        ASSERT_GE(anchors[v].face, 0);
        ASSERT_LT(anchors[v].face, static_cast<int>(coarse.faces.size()));
        EXPECT_GE(anchors[v].weights.minCoeff(), 0);
        EXPECT_NEAR(anchors[v].weights.sum(), 1, 1e-15);
        EXPECT_EQ(coarse.part[coarse.faces[anchors[v].face][0]], fine.part[v]);
    }
    for (std::size_t faces : {1U, 3U, 4U}) {
        const std::set<Edge> coarse_edges = curve_edges(coarse, faces);
        const std::set<int> coarse_vertices = ends_of(coarse_edges);
        for (int v : ends_of(curve_edges(fine, faces)))
            EXPECT_TRUE(on_curve(anchors[v], coarse, coarse_edges, coarse_vertices)) << "vertex " << v;
    }
}

TEST_P(HierarchyProperties, anchors_are_convex_and_keep_the_curves) {
    EXPECT_EQ(summary_.location_errors, 0);
    EXPECT_GT(summary_.worst_location, -1e-9);
    for (int l = 0; l < coarse_count(); ++l) {
        expect_sound(level(l).to_finest, level(l), hierarchy_.finest());
        expect_sound(level(l).to_next, level(l), level(l + 1));
    }
    EXPECT_TRUE(hierarchy_.finest().to_next.empty());
}

TEST_P(HierarchyProperties, anchors_are_near_their_vertices) {
    for (const LevelStatistics& statistics : hierarchy_statistics(hierarchy_)) {
        EXPECT_LE(statistics.largest_map_error, GetParam().largest_map_error);
        EXPECT_LE(statistics.mean_map_error, 0.3 * GetParam().largest_map_error + 1e-16);
        EXPECT_GT(statistics.worst_quality, 0.05);
    }
}

TEST_P(HierarchyProperties, topology_stays) {
    EXPECT_TRUE(summary_.topology_kept);
    const std::vector<LevelStatistics> statistics = hierarchy_statistics(hierarchy_);
    for (const LevelStatistics& coarse : statistics) {
        EXPECT_EQ(coarse.topology.euler_characteristic, statistics.back().topology.euler_characteristic);
        EXPECT_EQ(coarse.topology.boundary_loops, statistics.back().topology.boundary_loops);
        EXPECT_EQ(coarse.topology.components, statistics.back().topology.components);
        EXPECT_EQ(coarse.topology.graph, statistics.back().topology.graph);
    }
    EXPECT_EQ(hierarchy_.finest().faces, mesh_.faces);
    EXPECT_EQ(hierarchy_.finest().rest, mesh_.rest);
}

TEST_P(HierarchyProperties, reaches_the_sizes_asked_for) {
    EXPECT_FALSE(summary_.ran_dry);
    EXPECT_EQ(summary_.reached_vertices, summary_.wanted_vertices);
    for (int l = 0; l <= coarse_count(); ++l)
        EXPECT_EQ(static_cast<int>(level(l).vertex_ids.size()), summary_.reached_vertices[l]);
    EXPECT_EQ(summary_.reached_vertices.front(), std::min(GetParam().coarsest, mesh_.count()));
}

TEST_P(HierarchyProperties, nothing_intersects) {
    for (int l = 0; l <= coarse_count(); ++l)
        EXPECT_TRUE(intersecting_pairs(level(l).rest, level(l).faces).empty()) << "level " << l;
}

void expect_equal(const DynamicFaces& faces, const Hierarchy& hierarchy, int l) {
    const DynamicFaces expected(hierarchy, l);
    for (int f = 0; f < expected.face_id_count(); ++f) {
        ASSERT_EQ(faces.has_face(f), expected.has_face(f));
        ASSERT_EQ(faces.face(f), expected.face(f)) << "face " << f;
    }
    for (int v = 0; v < expected.vertex_id_count(); ++v)
        ASSERT_EQ(faces.vertex_faces(v), expected.vertex_faces(v));
}

TEST_P(HierarchyProperties, random_legal_orders_lead_to_the_next_level_exactly) {
    Random random(3);
    for (int l = 0; l < coarse_count(); ++l) {
        DynamicFaces faces(hierarchy_, l);
        std::vector<int> waiting;
        for (const auto& batch : level(l).batches)
            waiting.insert(waiting.end(), batch.begin(), batch.end());
        while (!waiting.empty()) {
            std::vector<int> legal;
            std::copy_if(waiting.begin(), waiting.end(), std::back_inserter(legal),
                         [&](int c) { return faces.is_legal(hierarchy_.collapses[c]); });
            ASSERT_FALSE(legal.empty());
            const int chosen = legal[random.below(static_cast<int>(legal.size()))];
            faces.expand(hierarchy_.collapses[chosen]);
            std::erase(waiting, chosen);
        }
        expect_equal(faces, hierarchy_, l + 1);
    }
}

TEST_P(HierarchyProperties, batches_are_legal_and_disjoint_and_complete) {
    std::size_t undone = 0;
    for (int l = 0; l < coarse_count(); ++l) {
        DynamicFaces faces(hierarchy_, l);
        for (const auto& batch : level(l).batches) {
            ASSERT_FALSE(batch.empty());
            std::set<int> touched;
            for (int c : batch) {
                const Collapse& collapse = hierarchy_.collapses[c];
                EXPECT_TRUE(faces.is_legal(collapse));
                EXPECT_TRUE(touched.insert(collapse.k).second);
                for (int v : collapse.ring)
                    EXPECT_TRUE(touched.insert(v).second);
            }
            for (int c : batch)
                faces.expand(hierarchy_.collapses[c]);
            undone += batch.size();
        }
        expect_equal(faces, hierarchy_, l + 1);
    }
    EXPECT_EQ(undone, hierarchy_.collapses.size());
}

TEST_P(HierarchyProperties, records_hold_the_neighbourhood) {
    DynamicFaces faces(hierarchy_, coarse_count());
    std::vector<int> ring;
    for (const Collapse& collapse : hierarchy_.collapses) {
        for (std::size_t d = 0; d < collapse.dead_faces.size(); ++d)
            EXPECT_EQ(faces.face(collapse.dead_faces[d]), collapse.dead_corners[d]);
        faces.collapse(collapse);
        faces.ring(collapse.k, ring);
        EXPECT_EQ(ring, collapse.ring);
    }
    expect_equal(faces, hierarchy_, 0);
}

TEST_P(HierarchyProperties, rest_positions_follow_the_records) {
    Positions rest(3, mesh_.rest.cols() + static_cast<Eigen::Index>(hierarchy_.collapses.size()));
    rest.leftCols(mesh_.rest.cols()) = mesh_.rest;
    for (const Collapse& collapse : hierarchy_.collapses) {
        EXPECT_EQ(collapse.rest_i, rest.col(collapse.i));
        EXPECT_EQ(collapse.rest_j, rest.col(collapse.j));
        rest.col(collapse.k) = collapse.rest_k;
    }
    for (int l = 0; l <= coarse_count(); ++l)
        for (std::size_t v = 0; v < level(l).vertex_ids.size(); ++v)
            EXPECT_EQ(level(l).rest.col(static_cast<Eigen::Index>(v)), rest.col(level(l).vertex_ids[v]));
}

TEST_P(HierarchyProperties, prolongations_keep_the_rest_shape_and_follow_rigid_motions) {
    const Mat3 turn = Eigen::AngleAxisd(2, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    const Positions moved = (turn * hierarchy_.finest().rest).colwise() + Vec3(1, 2, 3);
    for (int l = 0; l < coarse_count(); ++l)
        for (const auto kind : {ProlongationOperator::shell, ProlongationOperator::blend}) {
            const Prolongation prolongation = prolongation_to_finest(hierarchy_, l, kind);
            const Positions& rest = level(l).rest;
            EXPECT_LT((prolongation.apply(rest) - hierarchy_.finest().rest).cwiseAbs().maxCoeff(), 1e-13);
            const Positions turned = (turn * rest).colwise() + Vec3(1, 2, 3);
            EXPECT_LT((prolongation.apply(turned) - moved).cwiseAbs().maxCoeff(), 1e-12);
        }
}

bool in_hole(int x, int y) {
    return (x > 3 && x < 7 && y > 3 && y < 7) || (x > 9 && x < 12 && y > 8 && y < 12);
}

INSTANTIATE_TEST_SUITE_P(Meshes, HierarchyProperties,
                         testing::Values(Case{"regular_square", [] { return test::square(16); }, 30, 1e-12},
                                         Case{"irregular_square", [] { return test::square(16, 0.3); }, 30, 1e-12},
                                         Case{"curved_square", [] { return test::curved_square(18); }, 40, 0.03},
                                         Case{"sphere", [] { return test::sphere(20, 15); }, 30, 0.12},
                                         Case{"coarsest_sphere", [] { return test::sphere(10, 7); }, 8, 0.4},
                                         Case{"torus", [] { return test::torus(28, 14); }, 60, 0.1},
                                         Case{"annulus", [] { return test::annulus(36, 8); }, 50, 0.05},
                                         Case{"holes", [] { return test::square(16, 0, {}, in_hole); }, 60, 1e-12},
                                         Case{"scene", [] { return test::scene(); }, 110, 0.03},
                                         Case{"two_triangles", [] { return test::triangles(2); }, 4, 1e-16},
                                         Case{"rib_across", [] { return test::rib_panel(16, 0, 16, 0.25); }, 40, 1e-12},
                                         Case{"rib_inside", [] { return test::rib_panel(16, 3, 13, 0.25); }, 40, 1e-12},
                                         Case{"rib_at_a_corner", [] { return test::rib_panel(16, 0, 9); }, 40, 1e-12},
                                         Case{"honeycomb", [] { return test::honeycomb(8, 12); }, 60, 1e-12},
                                         Case{"crossed", [] { return test::crossed_sheets(10); }, 60, 0.05}),
                         [](const auto& tested) { return std::string(tested.param.name); });

} // namespace
} // namespace plisse
