#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include <plisse/drive/run.h>
#include <plisse/geometry/ccd.h>
#include <plisse/mesh/connectivity.h>

#include "small_models.h"

using namespace plisse;

namespace {

constexpr double thickness = 3e-3, distance = 0.02 * thickness;

/// Ten sheets with meshes of their own, lying askew above each other, `spacing` thicknesses apart, on a floor.
Model stack(double spacing) {
    Model model = empty_model("stack");
    for (int i = 1; i <= 10; ++i)
        add_body(model, ("sheet " + std::to_string(i)).c_str(), {1000, 1e6, 0.3, thickness, 1},
                 sheet_mesh(0.2, 0.04, static_cast<std::uint64_t>(i)),
                 Vec3(3e-3 * i, i * spacing * thickness, 2e-3 * i));
    Obstacle floor;
    floor.name = "floor";
    append_part(model, sheet_mesh(1, 0.25), Vec3::Zero(), floor.vertices, floor.faces);
    model.obstacles.push_back(floor);
    model.contact.distance = distance;
    model.contact.thickness = thickness;
    model.contact.friction = 0.3;
    model.hierarchy = {2, 250, ProlongationOperator::shell, BendingOn::level};
    model.solve.time_step = 0.05;
    return model;
}

/// Smallest distance between different parts, over all pairs of primitives, m.
double least_distance(const Hierarchy& hierarchy, const Positions& x) {
    const HierarchyLevel& mesh = hierarchy.finest();
    const auto squared = [&](StencilKind kind, int a, int b, int c, int d) {
        Stencil s;
        s << x.col(a), x.col(b), x.col(c), x.col(d);
        return squared_distance(kind, s);
    };
    const auto part = [&](int v) { return mesh.part[static_cast<std::size_t>(v)]; };
    double least = 1;
    std::set<Edge> edges;
    for (const Face& face : mesh.faces) {
        for (int v = 0; v < x.cols(); ++v)
            if (part(v) != part(face[0]))
                least = std::min(least, squared(StencilKind::point_triangle, v, face[0], face[1], face[2]));
        for (std::size_t i = 0; i < 3; ++i)
            edges.insert({std::min(face[i], face[(i + 1) % 3]), std::max(face[i], face[(i + 1) % 3])});
    }
    for (const Edge& a : edges)
        for (const Edge& b : edges)
            if (part(a[0]) < part(b[0]))
                least = std::min(least, squared(StencilKind::edge_edge, a[0], a[1], b[0], b[1]));
    return std::sqrt(least);
}

struct KeepHierarchy : Recorder {
    void on_hierarchy(const Hierarchy& h) override { hierarchy = h; }
    Hierarchy hierarchy;
};

class RestingStack : public testing::TestWithParam<std::tuple<Method, double>> {};

TEST_P(RestingStack, IsAsHighAsItsSheetsAreThick) {
    const auto [method, spacing] = GetParam();
    Model model = stack(spacing);
    model.solve.method = method;
    KeepHierarchy kept;
    Context context;
    const RunResult result = run(model, {}, kept, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_EQ(result.report.intersecting_pairs, 0);
    const double least = least_distance(kept.hierarchy, result.positions);
    EXPECT_GE(least, thickness);
    EXPECT_NEAR(result.report.levels.back().min_gap, least - thickness, 1e-12);
    EXPECT_NEAR(result.positions.row(1).maxCoeff(), 10 * thickness, 0.03 * 10 * thickness);
    EXPECT_GT(result.report.levels.back().energy.contact, 0);
}

/// Ten thicknesses high from above, and from sheets within each other's thickness.
INSTANTIATE_TEST_SUITE_P(, RestingStack,
                         testing::Combine(testing::Values(Method::direct, Method::progressive),
                                          testing::Values(1.3, 0.4)),
                         [](const auto& stack) {
                             const bool direct = std::get<0>(stack.param) == Method::direct;
                             return std::string(direct ? "Direct" : "Progressive") +
                                    (std::get<1>(stack.param) > 1 ? "FromAbove" : "FromWithin");
                         });

TEST(ContactThickness, LeavesABodyAtRestAlone) {
    Model model = empty_model("thick sheet with a fine mesh");
    add_body(model, "sheet", {}, sheet_mesh(0.2, 0.02));
    model.contact.distance = 1e-3;
    model.contact.thickness = 0.05;
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.hierarchy = {2, 40};
    KeepHierarchy kept;
    Context context;
    const RunResult result = run(model, {}, kept, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_LT((result.positions - model.mesh.positions).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(result.report.levels.back().energy.contact, 0);
}

} // namespace
