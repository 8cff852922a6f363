#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>

#include <plisse/drive/run.h>
#include <plisse/energy/neo_hookean.h>
#include <plisse/spatial/box.h>

#include "small_models.h"

using namespace plisse;

namespace {

RunResult run_with(Model model, Method method) {
    model.solve.method = method;
    Recorder recorder;
    Context context;
    RunResult result = run(model, {}, recorder, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    return result;
}

double total_energy(const RunResult& result) {
    const EnergyParts& parts = result.report.levels.back().energy;
    return parts.elastic + parts.contact + parts.gravity + parts.loads;
}

/// Both methods end in the same state.
void expect_one_equilibrium(const Model& model, const RunResult& progressive, const RunResult& direct) {
    ASSERT_EQ(progressive.positions.cols(), direct.positions.cols());
    const double energy = total_energy(direct);
    EXPECT_NEAR(total_energy(progressive), energy, 1e-4 * std::abs(energy));
    const double diagonal = bounding_box(model.mesh.positions).diagonal();
    EXPECT_LT((progressive.positions - direct.positions).colwise().norm().maxCoeff(), 1e-3 * diagonal);
}

/// A sheet held level by one whole edge, which falls and hangs.
Model hung_sheet() {
    Model model = empty_model("hung sheet");
    add_body(model, "sheet", {400, 2e6, 0.3, 1e-3, 1}, sheet_mesh(0.4, 0.025));
    Handle edge;
    edge.name = "edge";
    for (int v = 0; v < model.mesh.vertex_count(); ++v)
        if (model.mesh.positions(0, v) < -0.2 + 1e-9)
            edge.vertices.push_back(v);
    model.handles.push_back(edge);
    model.contact.distance = 1e-3;
    model.hierarchy = {3, 60};
    model.solve.time_step = 0.05;
    model.solve.duration = 1;
    model.solve.tolerance = 1e-5;
    return model;
}

/// A closed sphere under a pressure that rises to its last value.
struct Inflation {
    Model model;
    double radius = 0;  ///< m, three volumes over the area of the mesh
    double stretch = 0; ///< that the theory promises
};

Inflation inflated_sphere(double edge_length) {
    Inflation inflation;
    Model& model = inflation.model;
    model = empty_model("inflated sphere");
    Body& ball = add_body(model, "ball", {1000, 1e6, 0.3, 1e-3, 1}, sphere_mesh(0.1, edge_length));
    double area = 0, volume = 0;
    for (const Face& f : model.mesh.faces) {
        const Vec3 a = model.mesh.positions.col(f[0]), b = model.mesh.positions.col(f[1]),
                   c = model.mesh.positions.col(f[2]);
        area += 0.5 * (b - a).cross(c - a).norm();
        volume += a.dot(b.cross(c)) / 6;
    }
    inflation.radius = 3 * volume / area;
    inflation.stretch = 1.1;
    const Lame lame = plane_stress_lame(ball.material.youngs_modulus, ball.material.poisson_ratio);
    const double balance = 0.56107; // p R / (mu t) at 1.1 for a Poisson ratio of 0.3 (VALIDATION.md, P1)
    const double pressure = balance * lame.mu * ball.material.thickness / inflation.radius;
    ball.pressure.keys = {{0, 0.0}, {1, pressure}};
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.contact.distance = 1e-3;
    model.hierarchy = {3, 60};
    model.solve.time_step = 0.1;
    model.solve.duration = 1;
    model.solve.tolerance = 1e-5;
    return inflation;
}

double mean_radius(const Positions& x) {
    const Vec3 center = x.rowwise().mean();
    return (x.colwise() - center).colwise().norm().mean();
}

TEST(Equilibria, ASheetHungByAnEdgeComesToTheSameRestByBothMethods) {
    const Model model = hung_sheet();
    const RunResult progressive = run_with(model, Method::progressive);
    expect_one_equilibrium(model, progressive, run_with(model, Method::direct));
    EXPECT_LT(progressive.positions.row(1).minCoeff(), -0.25); // it does hang
}

TEST(Equilibria, ASheetBentByKoiterComesToTheSameRestByBothMethods) {
    Model model = hung_sheet();
    model.bodies[0].material.bending = BendingModel::koiter;
    const RunResult direct = run_with(model, Method::direct);
    for (BendingOn bending_on : {BendingOn::finest, BendingOn::level}) {
        model.hierarchy.bending_on = bending_on;
        expect_one_equilibrium(model, run_with(model, Method::progressive), direct);
    }
}

TEST(Equilibria, AnInflatedSphereComesToTheSameRestByBothMethods) {
    const Model model = inflated_sphere(0.02).model;
    expect_one_equilibrium(model, run_with(model, Method::progressive), run_with(model, Method::direct));
}

TEST(EquilibriaP1, AnInflatedSphereStretchesAsTheTableSays) {
    for (const auto& [edge_length, tolerance] : {std::pair{0.015, 5e-3}, {0.0075, 1e-3}}) {
        const Inflation inflation = inflated_sphere(edge_length);
        const RunResult result = run_with(inflation.model, Method::progressive);
        const double stretch = mean_radius(result.positions) / mean_radius(inflation.model.mesh.positions);
        EXPECT_NEAR(stretch, inflation.stretch, tolerance * inflation.stretch)
            << inflation.model.mesh.vertex_count() << " vertices";
    }
}

} // namespace
