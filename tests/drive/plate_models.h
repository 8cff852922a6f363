#pragma once

#include <functional>

#include <gtest/gtest.h>

#include <plisse/drive/run.h>

#include "small_models.h"

/// What the tests of beams, plates and shells with known answers build their models of.
namespace plisse {

/// A shell free of gravity and of contact with itself, to be solved directly.
inline Model shell_model(const TriangleMesh& mesh, const Material& material) {
    Model model = empty_model("shell");
    add_body(model, "shell", material, mesh);
    model.gravity = Track<Vec3>(Vec3::Zero());
    model.contact.distance = 1e-3 * material.thickness;
    model.contact.self = false;
    model.hierarchy.levels = 1;
    model.solve.method = Method::direct;
    model.solve.time_step = 0.1;
    model.solve.duration = 1;
    return model;
}

/// A flat strip in the xz-plane.
inline Model strip_model(double length, double width, std::array<int, 2> cells, const Material& material) {
    GeneratorOptions sheet;
    sheet.shape = GeneratorShape::sheet;
    sheet.pattern = Pattern::regular;
    sheet.size = Vec3(length, width, 0);
    sheet.cells = cells;
    return shell_model(generate_mesh(sheet), material);
}

inline std::vector<int> vertices_where(const Model& model, const std::function<bool(const Vec3&)>& chosen) {
    std::vector<int> vertices;
    for (int v = 0; v < model.mesh.vertex_count(); ++v)
        if (chosen(model.mesh.positions.col(v)))
            vertices.push_back(v);
    return vertices;
}

inline Handle& add_handle(Model& model, const std::string& name, std::array<bool, 3> axes, std::vector<int> vertices) {
    Handle handle;
    handle.name = name;
    handle.axes = axes;
    handle.vertices = std::move(vertices);
    model.handles.push_back(handle);
    return model.handles.back();
}

inline void add_load(Model& model, Load::Kind kind, std::vector<int> vertices, const Vec3& value) {
    Load load;
    load.kind = kind;
    load.vertices = std::move(vertices);
    load.value = Track<Vec3>(value);
    model.loads.push_back(load);
}

inline RunResult solve(const Model& model) {
    Recorder recorder;
    Context context;
    RunResult result = run(model, {}, recorder, context);
    EXPECT_EQ(result.report.status, RunStatus::converged) << result.report.message;
    return result;
}

inline constexpr std::array<bool, 3> clamped{true, true, true}, only_y{false, true, false},
    all_but_x{false, true, true};

} // namespace plisse
