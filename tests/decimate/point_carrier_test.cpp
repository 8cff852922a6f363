#include <plisse/decimate/point_carrier.h>

#include <gtest/gtest.h>

#include <numeric>

#include <plisse/decimate/edge_collapser.h>

#include <decimate/test_meshes.h>

namespace plisse {
namespace {

DecimationOptions options_to(int coarsest) {
    DecimationOptions options;
    options.coarsest_vertices = coarsest;
    return options;
}

/// Where an anchor on finest faces lies.
Vec3 place_of(const Anchor& anchor, std::span<const Face> faces, const Positions& rest) {
    Vec3 place = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
        place +=
            anchor.weights[static_cast<Eigen::Index>(k)] * rest.col(faces[static_cast<std::size_t>(anchor.face)][k]);
    return place;
}

/// Down to the coarsest level and back, every vertex must come to lie where it was: the map is one to one.
double worst_return(const test::TestMesh& mesh) {
    DecimationSummary summary;
    const CollapseSequence sequence = EdgeCollapser(mesh.input(), options_to(40), summary).run(nullptr);
    const int ids = static_cast<int>(sequence.vertices.size());
    std::vector<bool> on_curve;
    for (const VertexState& state : sequence.vertices)
        on_curve.push_back(state.on_curve);
    DynamicFaces faces(mesh.faces, ids);
    std::vector<int> all(mesh.points.size());
    std::iota(all.begin(), all.end(), 0);
    PointCarrier carrier(all, ids, faces.face_id_count());
    ChartTriangles triangles;
    for (std::size_t c = 0; c < sequence.collapses.size(); ++c) {
        triangles.lay_out(sequence.collapses[c], sequence.charts[c], faces, on_curve);
        carrier.carry(sequence.collapses[c], sequence.charts[c], triangles);
        faces.collapse(sequence.collapses[c]);
    }
    for (std::size_t c = sequence.collapses.size(); c-- > 0;) {
        faces.expand(sequence.collapses[c]);
        triangles.lay_out(sequence.collapses[c], sequence.charts[c], faces, on_curve);
        carrier.carry_back(sequence.collapses[c], sequence.charts[c], triangles);
    }
    EXPECT_GT(sequence.collapses.size(), mesh.points.size() / 2);
    EXPECT_EQ(carrier.errors(), 0);
    double worst = 0;
    for (int v : all)
        worst = std::max(worst, (place_of(carrier.anchor(v, faces), mesh.faces, mesh.rest) - mesh.points[v]).norm());
    return worst;
}

TEST(PointCarrier, brings_points_back_where_they_were) {
    EXPECT_LT(worst_return(test::sphere(30, 21)), 1e-9);
    EXPECT_LT(worst_return(test::scene()), 1e-9);
    EXPECT_LT(worst_return(test::rib_panel(20, 4, 16, 0.25)), 1e-9);
    EXPECT_LT(worst_return(test::honeycomb(8, 12)), 1e-9);
    EXPECT_LT(worst_return(test::crossed_sheets(10)), 1e-9);
}

TEST(OnFinest, lies_on_the_surface_near_the_vertex_and_on_it_where_it_was_kept) {
    const test::TestMesh mesh = test::sphere(40, 31);
    DecimationOptions options = options_to(60);
    const Hierarchy hierarchy = decimate(mesh.input(), options);
    for (const HierarchyLevel& level : hierarchy.levels) {
        ASSERT_EQ(level.on_input.size(), level.vertex_ids.size());
        for (std::size_t v = 0; v < level.vertex_ids.size(); ++v) {
            const Vec3 place = place_of(level.on_input[v], mesh.faces, mesh.rest);
            const double distance = (place - level.rest.col(static_cast<Eigen::Index>(v))).norm();
            const bool kept = level.vertex_ids[v] < mesh.count();
            EXPECT_LT(distance, kept ? 1e-12 : 0.15) << "vertex " << v; // of a sphere of radius 1
        }
    }
}

} // namespace
} // namespace plisse
