#include <gtest/gtest.h>

#include <plisse/contact/contact.h>
#include <plisse/drive/patch_relaxation.h>
#include <plisse/drive/refine.h>
#include <plisse/spatial/intersections.h>

#include "small_models.h"

using namespace plisse;

namespace {

constexpr double contact_distance = 2e-3;

/// Two sheets, far apart at rest.
Model two_sheets() {
    Model model = empty_model("two sheets");
    add_body(model, "lower", {}, sheet_mesh(0.3, 0.03, 1));
    add_body(model, "upper", {}, sheet_mesh(0.3, 0.03, 2), Vec3(0, 0.1, 0));
    model.contact.distance = contact_distance;
    model.hierarchy = {2, 40};
    return model;
}

/// Level 0 with the upper sheet brought down to this gap.
Positions pressed_together(const Discretization& discretization, double gap) {
    Positions x = discretization.start(0);
    for (int v = 0; v < x.cols(); ++v)
        if (discretization.mesh(0).part[static_cast<std::size_t>(v)] == 1)
            x(1, v) = gap;
    return x;
}

/// Smallest distance, m, of the sheets at x on a level.
double gap_at(const Discretization& discretization, int level, const Positions& x) {
    const HierarchyLevel& mesh = discretization.mesh(level);
    ContactOptions options;
    options.distance = contact_distance;
    options.self = false;
    Contact contact(CollisionMesh(mesh.rest, mesh.faces, mesh.part, {0, 0}), options);
    return contact.min_gap(x);
}

TEST(PatchRelaxation, OpensTheGapAroundAVertexAndHoldsAllOthers) {
    const Model model = two_sheets();
    Context context;
    const Discretization discretization(model, 2, context);
    const double gap = 1e-6;
    ExpandingMesh mesh(discretization, 0, pressed_together(discretization, gap), 0);
    const HierarchyLevel& level = discretization.mesh(0);
    int free = -1; // the upper sheet's vertex nearest to its middle
    double nearest = 1e9;
    for (std::size_t v = 0; v < level.part.size(); ++v) {
        const Vec3 p = level.rest.col(static_cast<int>(v)) - Vec3(0, 0.1, 0);
        if (level.part[v] == 1 && p.norm() < nearest) {
            nearest = p.norm();
            free = level.vertex_ids[v];
        }
    }
    const Positions before = mesh.positions();
    const double wanted = 1e-4;
    const std::vector<int> patch{free};
    relax_patch(mesh, patch, wanted, context);
    EXPECT_GT(mesh.position(free).y(), wanted);
    for (int id : level.vertex_ids)
        if (id != free) {
            EXPECT_EQ(mesh.position(id), Vec3(before.col(id)));
        }
    EXPECT_TRUE(intersecting_pairs(mesh.level_positions(0), level.faces, {}).empty());
}

TEST(PatchRelaxation, RefinementOfSheetsAMicrometreApartNeedsItAndStaysSafe) {
    const Model model = two_sheets();
    Context context;
    const Discretization discretization(model, 2, context);
    for (double gap : {1e-6, 1e-8}) {
        const RefineResult refined = refine(discretization, 0, pressed_together(discretization, gap), 0, context);
        ASSERT_TRUE(refined.complete) << refined.message;
        EXPECT_GT(refined.report.relaxed, 0) << gap;
        EXPECT_TRUE(intersecting_pairs(refined.positions, discretization.mesh(1).faces, {}).empty()) << gap;
        EXPECT_GT(gap_at(discretization, 1, refined.positions), gap);
    }
}

TEST(BatchMotion, LeavesRoomForTheBarrierWhereTheWayIsBlocked) {
    Model model = two_sheets();
    Handle pusher; // sends vertices of the upper sheet, which is at 0.1 m, to below the lower one
    pusher.name = "pusher";
    pusher.body = 1;
    for (int v = model.bodies[1].vertices.begin; v < model.bodies[1].vertices.end; ++v)
        if (model.mesh.positions(0, v) > 0)
            pusher.vertices.push_back(v);
    pusher.motion.translate.keys = {{0, Vec3::Zero()}, {1, Vec3(0, -0.12, 0)}};
    model.handles.push_back(pusher);
    Context context;
    const Discretization discretization(model, 2, context);
    const RefineResult refined =
        refine(discretization, 0, pressed_together(discretization, 3 * contact_distance), 1, context);
    ASSERT_TRUE(refined.complete) << refined.message;
    EXPECT_LT(gap_at(discretization, 1, refined.positions), contact_distance);
    EXPECT_GT(gap_at(discretization, 1, refined.positions), 0.25 * contact_distance);
}

} // namespace
