#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "plate_models.h"

using namespace plisse;

/// A heavy sheet on a flat table, against the closed forms of VALIDATION.md, C1.
namespace {

constexpr double g = 9.81;
constexpr double weight = 1000 * 1e-3 * g; ///< of the sheets here, per area, Pa

/// A sheet of no Poisson's ratio, so that strips bend as beams do, of rigidity B.
Material paper(double rigidity) {
    constexpr double thickness = 1e-3;
    Material material{1000, 12 * rigidity / std::pow(thickness, 3), 0, thickness, 1};
    material.bending = BendingModel::koiter;
    return material;
}

/// The strip lies `height` above a block whose top is the plane y = 0 and ends at x = edge.
Model strip_on_table(double length, double width, std::array<int, 2> cells, double rigidity, double height,
                     double edge) {
    Model model = strip_model(length, width, cells, paper(rigidity));
    model.mesh.positions.row(1).array() += height;
    model.start = model.mesh.positions;
    GeneratorOptions box;
    box.shape = GeneratorShape::box;
    box.size = Vec3(3, 0.1, 1);
    box.edge_length = 1;
    Obstacle table;
    table.name = "table";
    append_part(model, generate_mesh(box), Vec3(edge - 1.5, -0.05, 0), table.vertices, table.faces);
    model.obstacles.push_back(table);
    model.gravity = Track<Vec3>(Vec3(0, -g, 0));
    model.solve.tolerance = 1e-9;
    return model;
}

/// What the strip feels of the table, N upwards.
double table_force(const RunResult& result) {
    for (const Reaction& reaction : result.report.reactions)
        if (reaction.name == "table")
            return reaction.force.y();
    return std::nan("");
}

/// Mean height of the strip's vertices at a distance from the middle.
double height_at(const Model& model, const RunResult& result, double x) {
    double sum = 0;
    int count = 0;
    for (int v : vertices_where(model, [&](const Vec3& p) { return std::abs(p.x() - x) < 1e-9; }))
        if (v < model.bodies[0].vertices.end) {
            sum += result.positions(1, v);
            ++count;
        }
    return sum / count;
}

TEST(RestingSheetC1, LiesEverywhereAtOneGapWhicheverHeightItComesFrom) {
    constexpr double distance = 1e-3; // less than half of any of the heights: nearer pairs repel from nearer
    double gap = 0;
    for (const double height : {2e-3, 3e-3, 5e-3}) {
        Model model = strip_on_table(0.4, 0.2, {16, 8}, 1e-2, height, 1.5);
        model.contact.distance = distance;
        add_handle(model, "in place", {true, false, true},
                   vertices_where(model, [](const Vec3& p) { return std::abs(p.x()) < 1e-9 && p.y() > 0; }));
        const RunResult result = solve(model);
        const auto heights = result.positions.row(1).head(model.bodies[0].vertices.end);
        EXPECT_GT(heights.minCoeff(), 0);
        EXPECT_LT(heights.maxCoeff(), distance);
        EXPECT_LT(heights.maxCoeff() - heights.minCoeff(), 1e-6 * distance);
        EXPECT_NEAR(table_force(result), weight * 0.4 * 0.2, 1e-3 * weight * 0.4 * 0.2);
        if (gap > 0) {
            EXPECT_NEAR(heights.mean(), gap, 1e-5 * distance);
        }
        gap = heights.mean();
    }
}

TEST(RestingSheetC1, LiftedAtOneEndLeavesTheTableOverTheLengthOfABeam) {
    constexpr double lift = 0.01, width = 0.1, length = 1, free_length = 0.5;
    const double rigidity = std::pow(free_length, 4) * weight / (24 * lift);
    Model model = strip_on_table(length, width, {50, 5}, rigidity, 3e-4, 1.5);
    model.contact.distance = lift / 50;
    Handle& end = add_handle(model, "end", only_y,
                             vertices_where(model, [](const Vec3& p) { return p.x() > 0.5 - 1e-9 && p.y() > 0; }));
    end.motion.translate.keys = {{0, Vec3::Zero()}, {1, Vec3(0, lift, 0)}};
    add_handle(model, "in place", {true, false, true},
               vertices_where(model, [](const Vec3& p) { return p.x() < -0.5 + 1e-9 && p.y() > 0 && p.x() > -0.6; }));
    const RunResult result = solve(model);
    const double force = weight * width * free_length / 2;
    EXPECT_NEAR(table_force(result), weight * width * length - force, 0.05 * force);
    // Half way along the lifted length a beam is at 3/16 of the lift: where the sheet is so high tells that length.
    const double ground = height_at(model, result, -0.3);
    const double raised = height_at(model, result, 0.5) - ground;
    double halfway = 0;
    for (int cell = 0; cell < 50; ++cell) {
        const double x = -0.5 + 0.02 * cell;
        const double here = (height_at(model, result, x) - ground) / raised;
        const double next = (height_at(model, result, x + 0.02) - ground) / raised;
        if (here < 0.1875 && next >= 0.1875)
            halfway = x + 0.02 * (0.1875 - here) / (next - here);
    }
    EXPECT_NEAR(2 * (0.5 - halfway), free_length, 0.05 * free_length);
}

TEST(RestingSheetC1, OverhangingAnEdgeItLiftsOffBehindItWhateverItsRigidity) {
    constexpr double overhang = 0.1, width = 0.05, drop = 0.01, length = 0.5;
    const double rigidity = 0.242851 * weight * std::pow(overhang, 4) / drop;
    Model model = strip_on_table(length, width, {100, 10}, rigidity, 3e-4, length / 2 - overhang);
    model.contact.distance = drop / 50;
    add_handle(model, "in place", {true, false, true},
               vertices_where(model, [](const Vec3& p) { return p.x() < -0.25 + 1e-9 && p.y() > 0 && p.x() > -0.3; }));
    const RunResult result = solve(model);
    EXPECT_NEAR(table_force(result), weight * width * length, 0.01 * weight * width * length);
    const double edge = length / 2 - overhang;
    const double ground = height_at(model, result, -0.2);
    const double at_edge = height_at(model, result, edge);
    EXPECT_NEAR(at_edge - height_at(model, result, length / 2), drop, 0.05 * drop);
    // Between the table and the edge the strip is a beam whose reactions are 0.353553 and 2.06066 of weight times
    // overhang: it leaves the table sqrt(2) overhangs behind the edge, and is half of its greatest height up 0.6515
    // overhangs from there.
    double peak = 0, halfway = -1;
    for (int cell = 0; cell < 100; ++cell)
        peak = std::max(peak, height_at(model, result, -0.25 + 0.005 * cell) - ground);
    for (int cell = 0; cell < 80 && halfway < 0; ++cell) {
        const double x = -0.25 + 0.005 * cell;
        const double here = height_at(model, result, x) - ground, next = height_at(model, result, x + 0.005) - ground;
        if (here < peak / 2 && next >= peak / 2)
            halfway = x + 0.005 * (peak / 2 - here) / (next - here);
    }
    EXPECT_NEAR(peak, 0.0724 * drop, 0.05 * drop);
    const double lifted = std::sqrt(2) * overhang;
    EXPECT_NEAR(edge - halfway, lifted - 0.6515 * overhang, 0.05 * lifted);
}

} // namespace
