#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <plisse/base/parallel.h>

#include "plate_models.h"

using namespace plisse;

namespace {

/// Puts sheets together; points at the same place become one.
class SheetBuilder {
public:
    /// A sheet of n x m cells with alternating diagonals.
    void add(const Vec3& origin, const Vec3& along, const Vec3& up, int n, int m) {
        const auto at = [&](int a, int b) { return vertex(origin + along * a / n + up * b / m); };
        for (int b = 0; b < m; ++b)
            for (int a = 0; a < n; ++a) {
                const int p = at(a, b), q = at(a + 1, b), r = at(a + 1, b + 1), s = at(a, b + 1);
                if ((a + b) % 2 == 0) {
                    faces_.push_back({p, q, r});
                    faces_.push_back({p, r, s});
                } else {
                    faces_.push_back({p, q, s});
                    faces_.push_back({q, r, s});
                }
            }
    }

    TriangleMesh mesh() const {
        TriangleMesh result;
        result.faces = faces_;
        result.positions.resize(3, static_cast<int>(points_.size()));
        for (std::size_t v = 0; v < points_.size(); ++v)
            result.positions.col(static_cast<int>(v)) = points_[v];
        return result;
    }

private:
    int vertex(const Vec3& point) {
        const std::array<long, 3> key = {std::lround(1e7 * point.x()), std::lround(1e7 * point.y()),
                                         std::lround(1e7 * point.z())};
        const auto [entry, is_new] = numbers_.try_emplace(key, static_cast<int>(points_.size()));
        if (is_new)
            points_.push_back(point);
        return entry->second;
    }

    std::vector<Vec3> points_;
    std::vector<Face> faces_;
    std::map<std::array<long, 3>, int> numbers_;
};

/// A strip with a rib on its middle line, held at one end and loaded at the other: how far it gives way over what beam
/// theory has for its T-section, bending and shear of the rib together. rows: of cells over the rib's height.
double deflection_over_beam(int rows) {
    constexpr double length = 1, width = 0.1, height = 0.05, thickness = 2e-3, load = 1e-3;
    const Material material{1000, 1e9, 0, thickness, 1};
    SheetBuilder builder;
    builder.add({0, 0, 0.5 * width}, {length, 0, 0}, {0, 0, -width}, 20 * rows, 2 * rows);
    builder.add({0, 0, 0}, {length, 0, 0}, {0, height, 0}, 20 * rows, rows);
    Model model = shell_model(builder.mesh(), material);
    add_handle(model, "clamp", clamped, vertices_where(model, [](const Vec3& p) { return p.x() < 1e-9; }));
    const auto tip =
        vertices_where(model, [&](const Vec3& p) { return p.x() > length - 1e-9 && std::abs(p.z()) < 1e-9; });
    add_load(model, Load::Kind::force, tip, Vec3(0, -load, 0));
    model.solve.tolerance = 1e-9;
    const RunResult result = solve(model);
    double deflection = 0;
    for (int v : tip)
        deflection += (model.start(1, v) - result.positions(1, v)) / static_cast<double>(tip.size());

    const double panel = width * thickness, rib = height * thickness;
    const double centroid = rib * height / 2 / (panel + rib);
    const double second_moment = panel * (thickness * thickness / 12 + centroid * centroid) +
                                 rib * (height * height / 12 + std::pow(height / 2 - centroid, 2));
    const double youngs = material.youngs_modulus, shear = youngs / 2;
    return deflection / (load * std::pow(length, 3) / (3 * youngs * second_moment) + load * length / (shear * rib));
}

/// Flat triangles bend too stiffly in their plane, by an error that falls with the square of their size.
TEST(JoinedSheets, ACantileverOfTSectionBendsAsABeam) {
    const double coarse = deflection_over_beam(2), fine = deflection_over_beam(4);
    RecordProperty("deflection_over_beam_of_2_rows", std::to_string(coarse));
    RecordProperty("deflection_over_beam_of_4_rows", std::to_string(fine));
    EXPECT_NEAR(fine, 1, 0.07);
    EXPECT_NEAR((4 * fine - coarse) / 3, 1, 0.02);
}

/// A panel with a rib that ends inside it, a ball pressed onto the rib, on three levels.
Model pressed_rib() {
    Model model = empty_model("pressed rib");
    SheetBuilder builder;
    builder.add({-0.1, 0, 0.08}, {0.2, 0, 0}, {0, 0, -0.16}, 20, 16);
    builder.add({-0.07, 0, 0}, {0.14, 0, 0}, {0, 0.03, 0}, 14, 3);
    add_body(model, "panel", {1000, 1e7, 0.3, 1e-3, 1}, builder.mesh());
    Obstacle ball;
    ball.name = "ball";
    append_part(model, sphere_mesh(0.03, 0.012), Vec3(0.02, 0.063, 0.004), ball.vertices, ball.faces);
    ball.motion.translate.keys = {{0, Vec3::Zero()}, {0.4, Vec3(0, -0.015, 0)}};
    model.obstacles.push_back(ball);
    for (double side : {-0.1, 0.1})
        add_handle(model, side < 0 ? "left" : "right", clamped,
                   vertices_where(model, [&](const Vec3& p) { return std::abs(p.x() - side) < 1e-9 && p.y() < 0.01; }));
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.contact.distance = 2e-3;
    model.contact.friction = 0.2;
    model.hierarchy = {3, 110};
    model.solve.time_step = 0.1;
    model.solve.duration = 0.4;
    return model;
}

TEST(JoinedSheets, RunProgressivelyToTheSameBitsOnAnyNumberOfThreads) {
    const Model model = pressed_rib();
    const auto run_on = [&](int threads) {
        const ThreadLimit limit(threads);
        const RunResult result = solve(model);
        EXPECT_EQ(result.report.intersecting_pairs, 0);
        EXPECT_EQ(result.report.levels.size(), 3U);
        EXPECT_GT(result.report.levels.back().energy.contact, 0);
        EXPECT_GT(result.report.refinements.back().expansions, 0);
        return result.positions;
    };
    EXPECT_EQ(run_on(1), run_on(2));
}

TEST(JoinedSheets, RunWithKoiterBendingAndBlend) {
    Model model = pressed_rib();
    model.hierarchy = {2, 150, ProlongationOperator::blend};
    model.bodies.front().material.bending = BendingModel::koiter;
    model.solve.time_step = model.solve.duration = 0.2;
    EXPECT_EQ(solve(model).report.intersecting_pairs, 0);
}

} // namespace
