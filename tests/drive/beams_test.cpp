#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <plisse/energy/hinge.h>

#include "plate_models.h"

using namespace plisse;

namespace {

TEST(BeamsB2, CantileverOfRightTrianglesBendsAsMeasured) {
    constexpr double length = 10, width = 1, load = 1e-4;
    const Material material{1000, 1.2e6, 0, 0.1, 1};
    for (int cells : {20, 40}) {
        const double edge = length / cells;
        // One row of cells more: the clamp holds the root and a row behind it.
        GeneratorOptions sheet;
        sheet.shape = GeneratorShape::sheet;
        sheet.pattern = Pattern::regular;
        sheet.diagonals = Diagonals::one;
        sheet.size = Vec3(length + edge, width, 0);
        sheet.cells = {cells + 1, cells / 10};
        Model model = shell_model(generate_mesh(sheet), material);
        const double half = 0.5 * (length + edge);
        add_handle(model, "clamp", clamped,
                   vertices_where(model, [&](const Vec3& p) { return p.x() < -half + 1.5 * edge; }));
        const auto tip = vertices_where(model, [&](const Vec3& p) { return p.x() > half - 0.5 * edge; });
        add_load(model, Load::Kind::force, tip, Vec3(0, -load, 0));
        model.solve.tolerance = 1e-9;
        const RunResult result = solve(model);
        double deflection = 0;
        for (int v : tip)
            deflection -= result.positions(1, v) / static_cast<double>(tip.size());
        const double rigidity = bending_rigidity(material.youngs_modulus, 0, material.thickness);
        const double beam = load * std::pow(length, 3) / (3 * rigidity * width);
        const double discrete = 1 + 3.0 / (2 * cells) + 1.0 / (2 * cells * cells);
        RecordProperty("deflection_over_beam_" + std::to_string(cells), std::to_string(deflection / beam));
        // A strip cut along one diagonal has 0.8 of the rigidity (VALIDATION.md, B2).
        EXPECT_NEAR(deflection / (beam * discrete), 1.25, 0.03) << cells;
    }
}

TEST(BeamsB2, SimplySupportedPlateOfIrregularTriangles) {
    GeneratorOptions sheet;
    sheet.shape = GeneratorShape::sheet;
    sheet.size = Vec3(1, 1, 0);
    sheet.edge_length = 1.0 / 32;
    const Material material{1000, 1e7, 0.3, 0.01, 1};
    Model model = shell_model(generate_mesh(sheet), material);
    const auto on_edge = [](const Vec3& p) { return std::max(std::abs(p.x()), std::abs(p.z())) > 0.5 - 1e-9; };
    add_handle(model, "edge", only_y, vertices_where(model, on_edge));
    constexpr double pressure = 0.1;
    add_load(model, Load::Kind::traction, vertices_where(model, [](const Vec3&) { return true; }),
             Vec3(0, -pressure, 0));
    model.solve.tolerance = 1e-9;
    const RunResult result = solve(model);
    const double rigidity = bending_rigidity(material.youngs_modulus, material.poisson_ratio, material.thickness);
    const double center = -result.positions.row(1).minCoeff();
    const double ratio = center * rigidity / (.00406235 * pressure);
    RecordProperty("rigidity_over_D", std::to_string(1 / ratio));
    EXPECT_LT(center, 0.1 * material.thickness);
    EXPECT_NEAR(1 / ratio, 1, 0.06);
}

/// A strip of length 1 on pins at both ends.
Model pinned_strip(bool right_slides) {
    Model model = strip_model(1, 0.1, {40, 4}, {1000, 1e9, 0, 0.002, 1});
    add_handle(model, "left", clamped, vertices_where(model, [](const Vec3& p) { return p.x() < -0.5 + 1e-9; }));
    add_handle(model, "right", right_slides ? all_but_x : clamped,
               vertices_where(model, [](const Vec3& p) { return p.x() > 0.5 - 1e-9; }));
    return model;
}

double middle_deflection(const Model& model, const Positions& x) {
    const auto middle = vertices_where(model, [](const Vec3& p) { return std::abs(p.x()) < 1e-9; });
    double sum = 0;
    for (int v : middle)
        sum += std::abs(x(1, v));
    return sum / static_cast<double>(middle.size());
}

/// B of the strip as it is, N m^2, from 5 q L^4 / (384 B) under a small even load.
double measured_bending_stiffness() {
    Model model = pinned_strip(true);
    constexpr double load = 1e-4; // N in all
    add_load(model, Load::Kind::force, vertices_where(model, [](const Vec3&) { return true; }), Vec3(0, -load, 0));
    model.solve.tolerance = 1e-9;
    return 5 * load / (384 * middle_deflection(model, solve(model).positions));
}

TEST(BeamsK1, PinnedColumnBucklesAsTheElastica) {
    const double critical = std::numbers::pi * std::numbers::pi * measured_bending_stiffness();
    for (const auto& [shortening, force, deflection] : {std::tuple{.002, 1.00100, .02845},
                                                        {.03027, 1.01540, .10971},
                                                        {.11880, 1.06366, .21112},
                                                        {.25898, 1.15172, .29660}}) {
        Model model = pinned_strip(false);
        for (int v = 0; v < model.mesh.vertex_count(); ++v)
            model.start(1, v) = 1e-4 * std::cos(std::numbers::pi * model.start(0, v));
        model.handles.back().motion.translate.keys = {{0, Vec3::Zero()}, {1, Vec3(-shortening, 0, 0)}};
        model.solve.tolerance = 1e-6;
        const RunResult result = solve(model);
        EXPECT_NEAR(middle_deflection(model, result.positions), deflection, 5e-3 * deflection) << shortening;
        const double push = std::abs(result.report.reactions.back().force.x());
        RecordProperty("force_over_elastica_" + std::to_string(shortening), std::to_string(push / (critical * force)));
        // Far past buckling the strip can no longer curl across, which the small load let it do: its B grows, at most
        // by 9/8 as the Poisson ratio of hinges is -1/3.
        const double stiffening = shortening < 0.01 ? 1 : 1 + 1.0 / 16;
        EXPECT_GT(push / critical, 0.98 * force) << shortening;
        EXPECT_LT(push / critical, (stiffening + 0.02) * force) << shortening;
    }
}

} // namespace
