#pragma once

#include <functional>

#include <plisse/mesh/generate.h>
#include <plisse/model/subdivision_model.h>

namespace plisse {

/// A place of the boundary at rest.
using OnBoundary = std::function<bool(const Vec3&)>;

/// The sides of the finest level whose ends are both where the condition holds.
inline std::vector<int> boundary_sides(const SubdivisionModel& model, const OnBoundary& where) {
    const ControlMesh& mesh = model.levels.mesh(model.levels.level_count() - 1);
    std::vector<int> sides;
    for (std::size_t s = 0; s < mesh.boundary.size(); ++s) {
        const Quad& quad = mesh.faces[static_cast<std::size_t>(mesh.boundary[s].face)];
        const auto side = static_cast<std::size_t>(mesh.boundary[s].side);
        if (where(model.surface.positions.col(quad[side])) && where(model.surface.positions.col(quad[(side + 1) % 4])))
            sides.push_back(static_cast<int>(s));
    }
    return sides;
}

/// A square metre of denim of 4 x 4 faces on level 0, flat at height 0, held where the condition holds, which falls for
/// a second in one step: the setting of the paper's experiments.
inline SubdivisionModel square_metre(int levels, MaterialLaw law, const OnBoundary& held,
                                     SurfaceVariables variables = SurfaceVariables::boundary_curve) {
    SubdivisionModel model(SubdivisionLevels(quad_sheet({1, 1}, {4, 4}), levels, variables));
    model.name = "square metre";
    model.surface = limit_surface(model.levels, levels - 1);
    model.material.thickness = 6.6e-4;
    model.material.density = 0.4 / model.material.thickness;
    model.material.law = law;
    BoundaryHandle handle;
    handle.name = "held";
    handle.sides = boundary_sides(model, held);
    model.handles.push_back(handle);
    model.obstacles.positions.resize(3, 0);
    model.contact.self = false;
    model.solve.method = Method::rmtr;
    model.solve.time_step = model.solve.duration = model.solve.frame_interval = 1;
    model.solve.dynamics = true;
    model.solve.settle = false;
    return model;
}

inline void add_obstacle(SubdivisionModel& model, const std::string& name, const TriangleMesh& mesh) {
    const int first = model.obstacles.vertex_count();
    Positions all(3, first + mesh.vertex_count());
    all << model.obstacles.positions, mesh.positions;
    model.obstacles.positions = all;
    for (const Face& face : mesh.faces)
        model.obstacles.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    model.obstacle_of_vertex.resize(static_cast<std::size_t>(model.obstacles.vertex_count()),
                                    static_cast<int>(model.obstacle_names.size()));
    model.obstacle_names.push_back(name);
    model.obstacle_motions.emplace_back();
}

/// A triangle of ground below the middle of the sheet, or many times its size.
inline void add_ground(SubdivisionModel& model, double height, double scale = 1) {
    TriangleMesh ground;
    ground.positions.resize(3, 3);
    ground.positions.col(0) = Vec3(-0.4 * scale, height, 0.3 * scale);
    ground.positions.col(1) = Vec3(0.4 * scale, height, 0.3 * scale);
    ground.positions.col(2) = Vec3(0.05 * scale, height, -0.35 * scale);
    ground.faces = {{0, 1, 2}};
    add_obstacle(model, "ground", ground);
}

/// A ball as an obstacle.
inline void add_ball(SubdivisionModel& model, const Vec3& center, double radius) {
    GeneratorOptions generator;
    generator.shape = GeneratorShape::sphere;
    generator.radius = radius;
    generator.edge_length = radius / 4;
    TriangleMesh ball = generate_mesh(generator);
    ball.positions.colwise() += center;
    add_obstacle(model, "ball", ball);
}

inline bool nowhere(const Vec3&) {
    return false;
}
inline bool anywhere(const Vec3&) {
    return true;
}
inline bool on_two_sides(const Vec3& p) {
    return p.x() < -0.499 || p.z() < -0.499;
}

} // namespace plisse
