#pragma once

#include <plisse/mesh/generate.h>
#include <plisse/model/model.h>

namespace plisse {

inline void append_part(Model& model, const TriangleMesh& part, const Vec3& shift, Range& vertices, Range& faces) {
    const int first = model.mesh.vertex_count();
    vertices = {first, first + part.vertex_count()};
    faces = {model.mesh.face_count(), model.mesh.face_count() + part.face_count()};
    Positions all(3, vertices.end);
    all << model.mesh.positions, part.positions.colwise() + shift;
    model.mesh.positions = all;
    for (const Face& face : part.faces)
        model.mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
    model.start = model.mesh.positions;
}

/// A model with nothing in it yet.
inline Model empty_model(const char* name) {
    Model model;
    model.name = name;
    model.mesh.positions.resize(3, 0);
    return model;
}

/// The body is valid until the next one is added.
inline Body& add_body(Model& model, const char* name, const Material& material, const TriangleMesh& mesh,
                      const Vec3& shift = Vec3::Zero()) {
    Body body;
    body.name = name;
    body.material = material;
    append_part(model, mesh, shift, body.vertices, body.faces);
    model.bodies.push_back(body);
    return model.bodies.back();
}

inline TriangleMesh sheet_mesh(double size, double edge_length, std::uint64_t seed = 1) {
    GeneratorOptions options;
    options.shape = GeneratorShape::sheet;
    options.size = Vec3(size, size, 0);
    options.edge_length = edge_length;
    options.seed = seed;
    return generate_mesh(options);
}

inline TriangleMesh sphere_mesh(double radius, double edge_length) {
    GeneratorOptions options;
    options.shape = GeneratorShape::sphere;
    options.radius = radius;
    options.edge_length = edge_length;
    return generate_mesh(options);
}

/// A cloth above a ball, its crown kept from sliding, on three levels.
inline Model small_drape() {
    Model model = empty_model("small drape");
    const Body& cloth = add_body(model, "cloth", {}, sheet_mesh(0.6, 0.04), Vec3(0, 0.17, 0));
    Obstacle ball;
    ball.name = "ball";
    append_part(model, sphere_mesh(0.15, 0.05), Vec3::Zero(), ball.vertices, ball.faces);
    model.obstacles.push_back(ball);
    Handle crown;
    crown.name = "crown";
    crown.axes = {true, false, true};
    for (int v = 0; v < cloth.vertices.end; ++v)
        if ((model.mesh.positions.col(v) - Vec3(0, 0.17, 0)).norm() < 0.05)
            crown.vertices.push_back(v);
    model.handles.push_back(crown);
    model.contact.distance = 4e-3;
    model.hierarchy = {3, 70, ProlongationOperator::shell, BendingOn::level};
    model.solve.time_step = 0.05;
    model.solve.duration = 0.4;
    model.solve.frame_interval = 0.1;
    return model;
}

/// A soft closed ball pressed between two plates that meet their script.
inline Model small_press() {
    Model model = empty_model("small press");
    add_body(model, "ball", {1000, 1e6, 0.3, 1e-3, 1}, sphere_mesh(0.1, 0.03));
    GeneratorOptions box;
    box.shape = GeneratorShape::box;
    box.size = Vec3(0.3, 0.02, 0.3);
    box.edge_length = 0.15;
    for (double side : {1.0, -1.0}) {
        Obstacle plate;
        plate.name = side > 0 ? "upper" : "lower";
        plate.motion.translate.keys = {{0, Vec3::Zero()}, {0.4, Vec3(0, -0.02 * side, 0)}};
        append_part(model, generate_mesh(box), Vec3(0, 0.115 * side, 0), plate.vertices, plate.faces);
        model.obstacles.push_back(plate);
    }
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.contact.distance = 2e-3;
    model.hierarchy = {3, 60};
    model.solve.time_step = 0.05;
    model.solve.duration = 0.4;
    model.solve.frame_interval = 0.1;
    return model;
}

} // namespace plisse
