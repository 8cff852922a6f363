#include "bench_surfaces.h"

#include <functional>

#include <plisse/scene/material_presets.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

constexpr double half = 0.5; ///< m, of a side
constexpr double cut = 0.3;  ///< m, side of the square that is cut out

QuadMesh domain_of(Scenario scenario) {
    constexpr int cells = 4;
    QuadMesh mesh = quad_sheet({2 * half, 2 * half}, {cells, cells});
    if (scenario != Scenario::reentrant_corner)
        return mesh;
    // The last face is cut out. The other lines are a spacing s apart: the limit of the one at the cut, (2 s + 4 (3 s)
    // + 1)/6 from the side across as on a cubic spline, is to be 1 - cut.
    const double spacing = (6 * (2 * half - cut) - 2 * half) / 14;
    const auto placed = [&](double line) {
        return line > half - 1e-9 ? half : -half + spacing * (line + half) * cells;
    };
    for (auto p : mesh.positions.colwise())
        p = Vec3(placed(p.x()), 0, placed(p.z()));
    mesh.faces.pop_back();
    mesh.positions.conservativeResize(3, mesh.positions.cols() - 1);
    return mesh;
}

/// The finest level's parts of the sides of level 0 whose ends are both where the condition holds.
BoundaryHandle held_sides(const SubdivisionModel& model, const QuadMesh& domain,
                          const std::function<bool(const Vec3&)>& where) {
    const ControlMesh& mesh = model.levels.mesh(0);
    const int parts = 1 << (model.levels.level_count() - 1);
    BoundaryHandle handle;
    handle.name = "held";
    for (int s = 0; s < static_cast<int>(mesh.boundary.size()); ++s) {
        const auto [face, side] = mesh.boundary[at(s)];
        const Quad& quad = mesh.faces[at(face)];
        if (where(domain.positions.col(quad[at(side)])) && where(domain.positions.col(quad[at((side + 1) % 4)])))
            for (int part = 0; part < parts; ++part)
                handle.sides.push_back(s * parts + part);
    }
    return handle;
}

/// The corner of the domain nearest to a place, which moves along x.
BoundaryHandle moving_corner(const SubdivisionModel& model, const Vec3& place, double velocity) {
    BoundaryHandle handle;
    handle.name = velocity > 0 ? "left" : "right";
    Eigen::Index nearest = 0;
    (model.surface.positions.colwise() - place).colwise().squaredNorm().minCoeff(&nearest);
    handle.points = {static_cast<int>(nearest)};
    handle.motion.translate.keys = {{0, Vec3::Zero()}, {1, Vec3(velocity, 0, 0)}};
    return handle;
}

std::vector<BoundaryHandle> handles_of(Scenario scenario, const QuadMesh& domain, const SubdivisionModel& model) {
    const auto at_low_end = [](double line) { return line < -half + 1e-9; };
    const auto at_cut = [](double line) { return line > 0.1; };
    switch (scenario) {
    case Scenario::trampoline:
        return {held_sides(model, domain, [](const Vec3&) { return true; })};
    case Scenario::drooping:
        return {held_sides(model, domain, [&](const Vec3& p) { return at_low_end(p.x()) || at_low_end(p.z()); })};
    case Scenario::reentrant_corner:
        return {held_sides(model, domain, [&](const Vec3& p) { return at_cut(p.x()) && at_cut(p.z()); })};
    case Scenario::drape:
        break;
    }
    return {moving_corner(model, Vec3(-half, 0, -half), 0.2), moving_corner(model, Vec3(half, 0, -half), -0.2)};
}

} // namespace

const char* scenario_name(Scenario scenario) {
    switch (scenario) {
    case Scenario::trampoline:
        return "trampoline";
    case Scenario::drooping:
        return "drooping";
    case Scenario::reentrant_corner:
        return "re-entrant corner";
    case Scenario::drape:
        break;
    }
    return "drape";
}

SubdivisionModel scenario_model(Scenario scenario, int levels, bool boundary_variables) {
    const auto variables = boundary_variables ? SurfaceVariables::boundary_curve : SurfaceVariables::control_points;
    const QuadMesh domain = domain_of(scenario);
    SubdivisionModel model(SubdivisionLevels(domain, levels, variables));
    model.name = scenario_name(scenario);
    model.body = "cloth";
    model.surface = limit_surface(model.levels, levels - 1);
    model.material = find_material_preset("denim-stable")->material;
    model.handles = handles_of(scenario, domain, model);
    model.obstacles.positions.resize(3, 0);
    model.contact.self = false;
    model.solve.method = Method::rmtr;
    model.solve.rmtr.boundary_variables = boundary_variables;
    return model;
}

} // namespace plisse
