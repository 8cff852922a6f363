#include <plisse/scene/model_parameters.h>

#include <algorithm>

#include <fmt/core.h>

#include <plisse/mesh/connectivity.h>
#include <plisse/scene/contact_settings.h>
#include <plisse/scene/motion_track.h>

namespace plisse {

namespace {

/// Pressure needs an inside and an outside, or at least one front.
void expect_sides(const Scene& scene, const Model& model, const Body& body, const std::string& pointer) {
    const auto first = model.mesh.faces.begin();
    std::vector<Face> faces(first + body.faces.begin, first + body.faces.end); // in the body's own numbering
    for (Face& face : faces)
        for (int& v : face)
            v -= body.vertices.begin;
    const Connectivity connectivity(body.vertices.size(), faces);
    if (const auto joints = connectivity.non_manifold_edges(); !joints.empty()) {
        const Edge& edge = connectivity.edges()[static_cast<std::size_t>(joints.front())];
        throw scene.error_at(pointer,
                             fmt::format("sheets are joined at edges of more than two faces, such as {}-{}, so the "
                                         "body has no two sides for a pressure to act between",
                                         edge[0], edge[1]),
                             "give a load with a `traction` on the vertices that it acts on");
    }
}

void set_body(const Scene& scene, std::size_t number, Model& model) {
    const BodySpec& spec = scene.bodies[number];
    Body& body = model.bodies[number];
    if (is_zero(body.pressure) && !is_zero(spec.pressure))
        expect_sides(scene, model, body, fmt::format("/bodies/{}/pressure", number));
    body.material = spec.material;
    body.pressure = spec.pressure;
}

/// Per vertex of the body's own mesh, whether a face uses it.
std::vector<bool> used_vertices(const Model& model, const Body& body) {
    std::vector<bool> used(static_cast<std::size_t>(body.vertices.size()), false);
    for (int f = body.faces.begin; f < body.faces.end; ++f)
        for (int v : model.mesh.faces[static_cast<std::size_t>(f)])
            used[static_cast<std::size_t>(v - body.vertices.begin)] = true;
    return used;
}

Pull pull_of(const Scene& scene, const Model& model, std::size_t number) {
    const PullSpec& spec = scene.pulls[number];
    const auto body = std::find_if(model.bodies.begin(), model.bodies.end(),
                                   [&](const Body& candidate) { return candidate.name == spec.body; });
    Pull pull{spec.name, static_cast<int>(body - model.bodies.begin()), spec.stiffness, {}};
    const std::vector<bool> used = used_vertices(model, *body);
    for (std::size_t p = 0; p < spec.points.size(); ++p) {
        const PullPointSpec& point = spec.points[p];
        const auto vertex = static_cast<std::size_t>(point.vertex);
        if (vertex >= used.size() || !used[vertex])
            throw scene.error_at(fmt::format("/pulls/{}/points/{}/vertex", number, p),
                                 fmt::format("no face of \"{}\" has a vertex {}", body->name, point.vertex),
                                 fmt::format("give a number from 0 to {}", used.size() - 1));
        pull.points.push_back({body->vertices.begin + point.vertex, point.to});
    }
    return pull;
}

void set_pulls(const Scene& scene, Model& model) {
    if (!scene.pulls.empty() && scene.hierarchy.source == HierarchySource::loop)
        throw scene.error_at("/pulls", "pulls are not supported with levels by subdivision in this version",
                             "set `source` to \"decimation\", or leave them out");
    model.pulls.clear();
    for (std::size_t p = 0; p < scene.pulls.size(); ++p)
        model.pulls.push_back(pull_of(scene, model, p));
}

} // namespace

void set_parameters(const Scene& scene, Model& model) {
    for (std::size_t b = 0; b < scene.bodies.size(); ++b)
        set_body(scene, b, model);
    for (std::size_t o = 0; o < scene.obstacles.size(); ++o)
        model.obstacles[o].motion = motion_track(scene.obstacles[o].motion);
    for (std::size_t h = 0; h < scene.handles.size(); ++h)
        model.handles[h].motion = motion_track(scene.handles[h].motion);
    for (std::size_t l = 0; l < scene.loads.size(); ++l) {
        const LoadSpec& spec = scene.loads[l];
        model.loads[l].kind = spec.force ? Load::Kind::force : Load::Kind::traction;
        model.loads[l].value = spec.force ? *spec.force : *spec.traction;
    }
    set_pulls(scene, model);
    model.gravity = scene.gravity;
    model.contact = contact_settings(scene);
    model.solve = scene.solve;
}

} // namespace plisse
