#include <plisse/scene/build_subdivision_model.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/core.h>

#include <plisse/base/error.h>
#include <plisse/mesh/intersecting_surfaces.h>
#include <plisse/model/surface_contact.h>
#include <plisse/scene/contact_settings.h>
#include <plisse/scene/load_part.h>
#include <plisse/scene/motion_track.h>
#include <plisse/scene/select_vertices.h>
#include <plisse/spatial/intersections.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Refuses what a scene may ask of other methods.
void expect_known_to_rmtr(const Scene& scene) {
    const auto refuse = [&](const std::string& pointer, const std::string& what, const std::string& right) {
        throw scene.error_at(pointer, what + " the method rmtr in this version", right);
    };
    if (scene.bodies.size() != 1)
        refuse("/bodies", "more than one body is not supported by", "give one, or another method");
    for (std::size_t h = 0; h < scene.handles.size(); ++h)
        if (scene.handles[h].axes != std::array{true, true, true})
            refuse(fmt::format("/handles/{}/axes", h), "handles of some axes are not supported by",
                   "leave it out: all three are held");
    if (!scene.loads.empty())
        refuse("/loads", "loads are not supported by", "leave them out, or give another method");
    if (!scene.pulls.empty())
        refuse("/pulls", "pulls are not supported by", "leave them out, or give another method");
    const BodySpec& body = scene.bodies.front();
    if (!is_zero(body.pressure))
        refuse("/bodies/0/pressure", "pressure is not supported by", "leave it out, or give another method");
    if (body.rest.kind != RestSpec::Kind::as_given)
        refuse("/bodies/0/rest", "a rest shape of its own is not supported by", "give \"as-given\"");
    if (body.start)
        refuse("/bodies/0/start", "a start shape is not supported by", "leave it out");
    if (body.material.strain_limit)
        refuse("/bodies/0/material/strain_limit", "a strain limit is not supported by", "give null");
    if (body.material.bending_scale != 1)
        refuse("/bodies/0/material/bending_scale", "a bending scale is not supported by", "give 1");
}

/// Every level has four times the faces of the one before.
void expect_no_flood_of_faces(const Scene& scene, const QuadMesh& mesh) {
    constexpr double most = 2e6;
    const double faces = mesh.face_count() * std::pow(4.0, scene.hierarchy.levels - 1);
    if (faces > most)
        throw scene.error_at("/hierarchy/levels",
                             fmt::format("the finest level would have {:.3g} faces, more than {:.3g}", faces, most),
                             "give fewer levels: each has four times the faces of the one before");
}

SubdivisionLevels subdivided(const Scene& scene) {
    const BodySpec& body = scene.bodies.front();
    const std::string pointer = "/bodies/0/mesh";
    const QuadMesh mesh = load_quad_mesh(scene, body.mesh, body.transform, pointer);
    expect_no_flood_of_faces(scene, mesh);
    const SurfaceVariables variables =
        scene.solve.rmtr.boundary_variables ? SurfaceVariables::boundary_curve : SurfaceVariables::control_points;
    try {
        return SubdivisionLevels(mesh, scene.hierarchy.levels, variables);
    } catch (const InputError& error) {
        throw scene.error_at(pointer, error);
    }
}

std::vector<Vec3> warp_directions(const Scene& scene, int face_count) {
    const std::vector<Vec3>& directions = scene.bodies.front().warp.directions;
    if (directions.size() != 1 && std::ssize(directions) != face_count)
        throw scene.error_at("/bodies/0/warp",
                             fmt::format("{} directions for a mesh of {} faces", directions.size(), face_count),
                             "give one for all, or one for each face");
    return directions;
}

/// Turns selections into pieces of the finest level's boundary.
class BoundarySelector {
public:
    BoundarySelector(const Scene& scene, const SubdivisionLevels& levels, const TriangleMesh& surface)
        : scene_(scene), levels_(levels), surface_(surface), on_boundary_(at(surface.vertex_count()), false) {
        for (const BoundarySide& side : finest().boundary)
            for (const int v : ends(finest(), side))
                on_boundary_[at(v)] = true;
    }

    void select(const SelectSpec& spec, const std::string& pointer, BoundaryHandle& handle) const {
        const std::vector<int> taken = std::holds_alternative<VertexSelection>(spec)
                                           ? of_own_mesh(std::get<VertexSelection>(spec), pointer)
                                           : of_surface(spec, pointer);
        const auto is_taken = [&](int v) { return std::binary_search(taken.begin(), taken.end(), v); };
        std::set<int> alone(taken.begin(), taken.end());
        for (std::size_t s = 0; s < finest().boundary.size(); ++s) {
            const auto [a, b] = ends(finest(), finest().boundary[s]);
            if (!is_taken(a) || !is_taken(b))
                continue;
            handle.sides.push_back(static_cast<int>(s));
            alone.erase(a);
            alone.erase(b);
        }
        handle.points.assign(alone.begin(), alone.end());
    }

private:
    const ControlMesh& finest() const { return levels_.mesh(levels_.level_count() - 1); }
    static Edge ends(const ControlMesh& mesh, const BoundarySide& side) {
        const Quad& quad = mesh.faces[at(side.face)];
        return {quad[at(side.side)], quad[at((side.side + 1) % 4)]};
    }

    /// Of the finest limit surface, ascending.
    std::vector<int> of_surface(const SelectSpec& spec, const std::string& pointer) const {
        std::vector<int> taken = select_vertices(scene_, spec, surface_, pointer);
        std::erase_if(taken, [&](int v) { return !on_boundary_[at(v)]; });
        if (taken.empty())
            throw scene_.error_at(pointer, "no point of the boundary is selected",
                                  "by the method rmtr handles hold pieces of a boundary: widen the selection");
        return taken;
    }

    /// The same from vertices of level 0: with all that lies on its sides between them.
    std::vector<int> of_own_mesh(const VertexSelection& selection, const std::string& pointer) const {
        const ControlMesh& own = levels_.mesh(0);
        std::set<int> chosen, taken;
        for (const int v : selection.vertices) {
            if (v >= own.domain_vertex_count)
                throw scene_.error_at(pointer, fmt::format("the mesh has no vertex {}", v),
                                      fmt::format("give vertices from 0 to {}", own.domain_vertex_count - 1));
            chosen.insert(v);
            taken.insert(descendant(v));
            if (!on_boundary_[at(descendant(v))])
                throw scene_.error_at(pointer, fmt::format("vertex {} is not on the boundary", v),
                                      "by the method rmtr handles hold pieces of a boundary: select its vertices");
        }
        const int parts = 1 << (levels_.level_count() - 1);
        for (std::size_t s = 0; s < own.boundary.size(); ++s) {
            const auto [a, b] = ends(own, own.boundary[s]);
            if (!chosen.contains(a) || !chosen.contains(b))
                continue;
            for (int part = 0; part < parts; ++part)
                for (const int v : ends(finest(), finest().boundary[s * at(parts) + at(part)]))
                    taken.insert(v);
        }
        if (taken.empty())
            throw scene_.error_at(pointer, "no vertex is selected", "give at least one vertex of the boundary");
        return {taken.begin(), taken.end()};
    }

    /// The finest vertex that a vertex of level 0 became.
    int descendant(int v) const {
        for (int l = 0; l + 1 < levels_.level_count(); ++l)
            v = levels_.step(l).vertex_child[at(v)];
        return v;
    }

    const Scene& scene_;
    const SubdivisionLevels& levels_;
    const TriangleMesh& surface_;
    std::vector<bool> on_boundary_; ///< per domain vertex of the finest level
};

void add_obstacles(const Scene& scene, SubdivisionModel& model, Context& context) {
    model.obstacles.positions.resize(3, 0);
    for (std::size_t o = 0; o < scene.obstacles.size(); ++o) {
        const ObstacleSpec& spec = scene.obstacles[o];
        const std::string pointer = fmt::format("/obstacles/{}/mesh", o);
        const TriangleMesh mesh = load_mesh(scene, spec.mesh, spec.transform, pointer, context);
        expect_usable(scene, mesh, spec.mesh, pointer, true);
        append_mesh(model.obstacles, mesh);
        model.obstacle_of_vertex.resize(at(model.obstacles.vertex_count()), static_cast<int>(o));
        model.obstacle_names.push_back(spec.name);
        model.obstacle_motions.push_back(motion_track(spec.motion));
    }
}

/// The cloth must begin clear of itself and of the obstacles.
void expect_no_intersections(const Scene& scene, const SubdivisionModel& model) {
    TriangleMesh all = model.surface;
    append_mesh(all, model.obstacles);
    all.positions.rightCols(model.obstacles.vertex_count()) = model.obstacles_at(0);
    std::vector<int> part(all.faces.size(), 0);
    const auto cloth_faces = static_cast<int>(model.surface.faces.size());
    for (std::size_t f = 0; f < model.obstacles.faces.size(); ++f)
        part[model.surface.faces.size() + f] = 1 + model.obstacle_of_vertex[at(model.obstacles.faces[f][0])];
    const auto of_obstacles = [&](int a, int b) { return a >= cloth_faces && b >= cloth_faces; };
    const auto pairs = intersecting_pairs(all.positions, all.faces, of_obstacles);
    if (pairs.empty())
        return;
    const Vec3 place = meeting_place(all.positions, all.faces[at(pairs.front()[0])], all.faces[at(pairs.front()[1])]);
    throw IntersectingSurfaces(
        scene.error_at("/bodies/0",
                       fmt::format("{} pairs of faces intersect at rest, the first near ({:.6g}, {:.6g}, {:.6g})",
                                   pairs.size(), place.x(), place.y(), place.z()),
                       "separate the surfaces, by `transform` or in the meshes"),
        all.positions, all.faces, pairs, part);
}

/// And of what contact thickness asks for: within one body that is never more than it is apart at rest.
void expect_outside_thickness(const Scene& scene, const SubdivisionModel& model, Context& context) {
    if (model.contact.thickness == 0)
        return;
    SurfaceContact contact(model, context);
    if (contact.contact().least_thickness_share(contact.with_obstacles(model.surface.positions)) < 1)
        throw scene.error_at("/contact/thickness", "the cloth begins nearer to an obstacle than this",
                             "move it further away, or give less");
}

} // namespace

SubdivisionModel build_subdivision_model(const Scene& scene, Context& context) {
    expect_known_to_rmtr(scene);
    const BodySpec& body = scene.bodies.front();
    SubdivisionModel model(subdivided(scene));
    model.name = scene.name;
    model.body = body.name;
    model.surface = limit_surface(model.levels, model.levels.level_count() - 1);
    model.material = body.material;
    model.warp = warp_directions(scene, model.levels.mesh(0).domain_face_count);
    model.contact = contact_settings(scene);
    add_obstacles(scene, model, context);
    expect_no_intersections(scene, model);
    expect_outside_thickness(scene, model, context);
    const BoundarySelector selector(scene, model.levels, model.surface);
    for (std::size_t i = 0; i < scene.handles.size(); ++i) {
        const HandleSpec& spec = scene.handles[i];
        BoundaryHandle& handle = model.handles.emplace_back();
        handle.name = spec.name;
        handle.axes = spec.axes;
        handle.motion = motion_track(spec.motion);
        selector.select(spec.select, fmt::format("/handles/{}/select", i), handle);
    }
    model.gravity = scene.gravity;
    model.solve = scene.solve;
    return model;
}

} // namespace plisse
