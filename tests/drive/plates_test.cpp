#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>

#include <plisse/energy/hinge.h>

#include "plate_models.h"

/// Plate and shell theory by koiter bending (VALIDATION.md).

using namespace plisse;

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::array<bool, 3> only_x{true, false, false}, only_z{false, false, true};

Material koiter(double youngs_modulus, double poisson_ratio, double thickness, double density = 1000) {
    return {density, youngs_modulus, poisson_ratio, thickness, 1, std::nullopt, BendingModel::koiter};
}

bool on_square_edge(const Vec3& p) {
    return std::max(std::abs(p.x()), std::abs(p.z())) > 0.5 - 1e-9;
}

bool anywhere(const Vec3&) {
    return true;
}

double rigidity(const Material& material) {
    return bending_rigidity(material.youngs_modulus, material.poisson_ratio, material.thickness);
}

TEST(PlatesB2, SimplySupportedSquareUnderPressure) {
    const Material material = koiter(1e7, 0.3, 0.01);
    Model model = shell_model(sheet_mesh(1, 1.0 / 24), material);
    add_handle(model, "edge", only_y, vertices_where(model, on_square_edge));
    constexpr double pressure = 0.1;
    add_load(model, Load::Kind::traction, vertices_where(model, anywhere), Vec3(0, -pressure, 0));
    model.solve.tolerance = 1e-9;
    const double deflection = -solve(model).positions.row(1).minCoeff();
    EXPECT_LT(deflection, 0.1 * material.thickness);
    EXPECT_NEAR(deflection * rigidity(material) / (.00406235 * pressure), 1, 0.02);
}

/// Its deflection depends on Poisson's ratio: the hinge's -1/3 would be half off.
TEST(PlatesB2, SimplySupportedDiscUnderPressure) {
    GeneratorOptions disc; // a dome with a sag of half a thousandth of its thickness
    disc.shape = GeneratorShape::dome;
    disc.radius = 1e5;
    disc.angle_deg = 1e-5 * 180 / pi;
    disc.edge_length = 0.08;
    const Material material = koiter(1e7, 0.3, 0.01);
    Model model = shell_model(generate_mesh(disc), material);
    add_handle(model, "rim", only_y,
               vertices_where(model, [](const Vec3& p) { return std::hypot(p.x(), p.z()) > 1 - 1e-6; }));
    constexpr double pressure = 0.005;
    add_load(model, Load::Kind::traction, vertices_where(model, anywhere), Vec3(0, -pressure, 0));
    model.solve.tolerance = 1e-9;
    const Positions x = solve(model).positions;
    const double deflection = (model.mesh.positions.row(1) - x.row(1)).maxCoeff();
    EXPECT_LT(deflection, 0.1 * material.thickness);
    EXPECT_NEAR(deflection * rigidity(material) / (.063702 * pressure), 1, 0.02);
}

TEST(PlatesB2, ASheetThatDoesNotBendHangsAsAMembrane) {
    Material material = koiter(1e5, 0.3, 0.01);
    material.bending_scale = 0;
    Model model = shell_model(sheet_mesh(1, 0.2), material);
    model.gravity = Track<Vec3>(Vec3(0, -9.81, 0));
    add_handle(model, "edge", clamped, vertices_where(model, on_square_edge));
    EXPECT_LT(solve(model).positions.row(1).minCoeff(), -0.01);
}

TEST(PlatesB3, CantileverUnderADeadTipLoad) {
    constexpr double length = 10, edge = 0.25;
    // One row of cells more: the clamp holds the root and a row behind it.
    Model model = strip_model(length + edge, 1, {41, 4}, koiter(1.2e6, 0, 0.1, 1e-3));
    const double half = 0.5 * (length + edge);
    add_handle(model, "clamp", clamped,
               vertices_where(model, [&](const Vec3& p) { return p.x() < -half + 1.5 * edge; }));
    const auto tip = vertices_where(model, [&](const Vec3& p) { return p.x() > half - 1e-9; });
    add_load(model, Load::Kind::force, tip, Vec3(0, -4, 0));
    model.solve.tolerance = 1e-6;
    const RunResult result = solve(model);
    double along = 0, down = 0;
    for (int v : tip) {
        along += (model.mesh.positions(0, v) - result.positions(0, v)) / static_cast<double>(tip.size());
        down -= result.positions(1, v) / static_cast<double>(tip.size());
    }
    EXPECT_NEAR(along, 3.286, 0.02 * 3.286);
    EXPECT_NEAR(down, 6.698, 0.02 * 6.698);
}

TEST(PlatesK1, PinnedColumnBucklesAsTheElastica) {
    const Material material = koiter(1e9, 0, 0.002);
    const double critical = pi * pi * rigidity(material) * 0.1;
    for (const auto& [shortening, force, deflection] :
         {std::tuple{.002, 1.00100, .02845}, {.11880, 1.06366, .21112}, {.25898, 1.15172, .29660}}) {
        Model model = strip_model(1, 0.1, {40, 4}, material);
        add_handle(model, "left", clamped, vertices_where(model, [](const Vec3& p) { return p.x() < -0.5 + 1e-9; }));
        add_handle(model, "right", clamped, vertices_where(model, [](const Vec3& p) { return p.x() > 0.5 - 1e-9; }));
        for (int v = 0; v < model.mesh.vertex_count(); ++v)
            model.start(1, v) = 1e-4 * std::cos(pi * model.start(0, v));
        model.handles.back().motion.translate.keys = {{0, Vec3::Zero()}, {1, Vec3(-shortening, 0, 0)}};
        model.solve.tolerance = 1e-6;
        const RunResult result = solve(model);
        EXPECT_NEAR(result.positions.row(1).cwiseAbs().maxCoeff(), deflection, 0.01 * deflection) << shortening;
        EXPECT_NEAR(std::abs(result.report.reactions.back().force.x()) / critical, force, 0.02 * force) << shortening;
    }
}

/// Largest deflection of a simply supported square under a share of its critical load.
double buckled_by(double share) {
    const Material material = koiter(1e7, 0.3, 0.01);
    const double critical = 4 * pi * pi * rigidity(material);
    Model model = shell_model(sheet_mesh(1, 1.0 / 24), material);
    for (int v = 0; v < model.mesh.vertex_count(); ++v)
        model.start(1, v) = 1e-4 * std::cos(pi * model.start(0, v)) * std::cos(pi * model.start(2, v));
    add_handle(model, "edge", only_y, vertices_where(model, on_square_edge));
    add_handle(model, "left", only_x, vertices_where(model, [](const Vec3& p) { return p.x() < -0.5 + 1e-9; }));
    add_handle(model, "right", only_x, vertices_where(model, [](const Vec3& p) { return p.x() > 0.5 - 1e-9; }));
    const double shortening = share * critical / (material.youngs_modulus * material.thickness);
    model.handles.back().motion.translate.keys = {{0, Vec3::Zero()}, {1, Vec3(-shortening, 0, 0)}};
    model.solve.tolerance = 1e-8;
    return solve(model).positions.row(1).cwiseAbs().maxCoeff();
}

TEST(PlatesK2, SquareBucklesAtItsCriticalLoad) {
    EXPECT_LT(buckled_by(0.98), 1e-4);
    EXPECT_GT(buckled_by(1.02), 5e-4);
}

/// Axial force over the classical one of a cylinder whose ends do not widen, at a share of the classical end strain.
double cylinder_force(double share) {
    GeneratorOptions options;
    options.shape = GeneratorShape::cylinder;
    options.radius = 1;
    options.height = 0.5;
    options.edge_length = 0.035;
    const Material material = koiter(1e6, 0.3, 0.01);
    Model model = shell_model(generate_mesh(options), material);
    add_handle(model, "foot", clamped, vertices_where(model, [](const Vec3& p) { return p.y() < -0.25 + 1e-9; }));
    add_handle(model, "rim", clamped, vertices_where(model, [](const Vec3& p) { return p.y() > 0.25 - 1e-9; }));
    const double shortening = share * 6.052e-3 * 0.5;
    model.handles.back().motion.translate.keys = {{0, Vec3::Zero()}, {1, Vec3(0, -shortening, 0)}};
    model.solve.tolerance = 1e-4;
    return std::abs(solve(model).report.reactions.back().force.y()) / 380.276;
}

TEST(PlatesK3, CylinderBucklesInItsBand) {
    EXPECT_NEAR(cylinder_force(0.5), 0.5, 0.03);
    EXPECT_LT(cylinder_force(1.3), 1.0) << "buckled";
}

/// The positions at the end of each step of the timeline.
struct Steps : Recorder {
    void on_frame(const Frame& frame) override {
        if (frame.phase == "preview" && frame.t > 0)
            positions.push_back(*frame.positions);
    }
    std::vector<Positions> positions;
};

/// Loads rise to the next of the given shares in each step of a second. Next to no inertia: every step comes to rest.
std::vector<Positions> solve_in_steps(Model& model, const std::vector<double>& shares) {
    for (Load& load : model.loads) {
        const Vec3 full = load.value.keys.front().value;
        load.value.keys = {{0, Vec3::Zero()}};
        for (std::size_t k = 0; k < shares.size(); ++k)
            load.value.keys.push_back({static_cast<double>(k + 1), shares[k] * full});
    }
    model.solve.time_step = model.solve.frame_interval = 1;
    model.solve.duration = static_cast<double>(shares.size());
    model.solve.tolerance = 1e-4;
    Steps steps;
    Context context;
    const RunResult result = run(model, {}, steps, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    EXPECT_EQ(steps.positions.size(), shares.size());
    return steps.positions;
}

/// Vertices on a grid of rows and columns, two triangles a cell with alternating diagonals, columns closed in a ring or
/// not. Normals point along (next column) x (next row).
TriangleMesh grid(int rows, int columns, bool ring, const std::function<Vec3(int, int)>& place) {
    TriangleMesh mesh;
    mesh.positions.resize(3, rows * columns);
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i)
            mesh.positions.col(j * columns + i) = place(j, i);
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i < columns - (ring ? 0 : 1); ++i) {
            const int next = (i + 1) % columns;
            const int a = j * columns + i, b = j * columns + next, c = b + columns, d = a + columns;
            if ((i + j) % 2 == 0)
                mesh.faces.insert(mesh.faces.end(), {{a, b, c}, {a, c, d}});
            else
                mesh.faces.insert(mesh.faces.end(), {{a, b, d}, {b, c, d}});
        }
    return mesh;
}

/// Largest error of both displacements over Sze's, over all loads, of the pinched hemisphere.
double hemisphere_error(int edges_a_quarter) {
    const int columns = 4 * edges_a_quarter, rows = static_cast<int>(std::round(0.8 * edges_a_quarter)) + 1;
    const TriangleMesh mesh = grid(rows, columns, true, [&](int j, int i) -> Vec3 {
        const double colatitude = pi / 2 - 0.4 * pi * j / (rows - 1), longitude = 2 * pi * i / columns;
        return 10 * Vec3(std::sin(colatitude) * std::cos(longitude), std::cos(colatitude),
                         std::sin(colatitude) * std::sin(longitude));
    });
    Model model = shell_model(mesh, koiter(6.825e7, 0.3, 0.04, 1e-2));
    constexpr double force = 400;
    const int q = edges_a_quarter;
    add_load(model, Load::Kind::force, {0}, Vec3(force, 0, 0));
    add_load(model, Load::Kind::force, {q}, Vec3(0, 0, -force));
    add_load(model, Load::Kind::force, {2 * q}, Vec3(-force, 0, 0));
    add_load(model, Load::Kind::force, {3 * q}, Vec3(0, 0, force));
    add_handle(model, "x", only_x, vertices_where(model, [](const Vec3& p) { return std::abs(p.x()) < 1e-9; }));
    add_handle(model, "z", only_z, vertices_where(model, [](const Vec3& p) { return std::abs(p.z()) < 1e-9; }));
    add_handle(model, "y", only_y, {q});
    const std::vector<Positions> steps = solve_in_steps(model, {.05, .1, .2, .3, .4, .5, .75, 1});
    const double outward[] = {.855, 1.499, 2.321, 2.819, 3.158, 3.406, 3.816, 4.067};
    const double inward[] = {.955, 1.840, 3.261, 4.339, 5.196, 5.902, 7.234, 8.178};
    double worst = 0;
    for (std::size_t k = 0; k < steps.size(); ++k)
        worst = std::max(
            {worst, std::abs((steps[k](0, 0) - 10) / outward[k] - 1), std::abs((10 - steps[k](2, q)) / inward[k] - 1)});
    return worst;
}

TEST(ShellsS1, PinchedHemisphereConverges) {
    const double coarse = hemisphere_error(8), fine = hemisphere_error(16);
    EXPECT_LT(fine, 0.03);
    EXPECT_LT(fine, 0.6 * coarse);
}

/// Largest error of both displacements over Sze's, over all loads, of the slit annular plate.
double slit_plate_error(int across, int around) {
    // A sliver behind the slit's fixed edge clamps it; its twin's width is left open before the other edge.
    constexpr double sliver = 0.02;
    const TriangleMesh mesh = grid(around + 2, across + 1, false, [&](int j, int i) -> Vec3 {
        const double radius = 6 + 4.0 * i / across;
        const double angle = 2 * pi / around * (j == 0 ? -sliver : (j - 1) * (1 - 2 * sliver / around));
        return {radius * std::cos(angle), 0, -radius * std::sin(angle)};
    });
    Model model = shell_model(mesh, koiter(21e6, 0, 0.03, 1e-4));
    std::vector<int> fixed(static_cast<std::size_t>(2 * (across + 1)));
    std::iota(fixed.begin(), fixed.end(), 0);
    add_handle(model, "clamp", clamped, fixed);
    const int inner = (around + 1) * (across + 1), outer = inner + across;
    for (int v = inner; v <= outer; ++v)
        add_load(model, Load::Kind::force, {v}, Vec3(0, 0.8 * 4 / across * (v == inner || v == outer ? 0.5 : 1), 0));
    const std::vector<Positions> steps = solve_in_steps(model, {.05, .1, .2, .4, .7, 1});
    const double at_outer[] = {3.370, 5.876, 9.160, 12.661, 15.469, 17.528};
    const double at_inner[] = {2.455, 4.277, 6.725, 9.529, 11.970, 13.891};
    double worst = 0;
    for (std::size_t k = 0; k < steps.size(); ++k)
        worst = std::max(
            {worst, std::abs(steps[k](1, outer) / at_outer[k] - 1), std::abs(steps[k](1, inner) / at_inner[k] - 1)});
    return worst;
}

TEST(ShellsS2, SlitAnnularPlateConverges) {
    const double coarse = slit_plate_error(4, 32), fine = slit_plate_error(8, 72);
    EXPECT_LT(fine, 0.03);
    EXPECT_LT(fine, 0.6 * coarse);
}

} // namespace
