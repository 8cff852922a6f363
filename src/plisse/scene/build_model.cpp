#include <plisse/scene/build_model.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/core.h>

#include <plisse/energy/rest_triangles.h>
#include <plisse/mesh/intersecting_surfaces.h>
#include <plisse/scene/load_part.h>
#include <plisse/scene/model_parameters.h>
#include <plisse/scene/select_vertices.h>
#include <plisse/spatial/intersections.h>

namespace plisse {

namespace {

/// Puts a model together; each function adds one kind of thing, in the order they are called.
class ModelBuilder {
public:
    ModelBuilder(const Scene& scene, Context& context) : scene_(scene), context_(context) {}

    Model build() {
        model_.name = scene_.name;
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i)
            add_body(scene_.bodies[i], fmt::format("/bodies/{}", i));
        for (std::size_t i = 0; i < scene_.obstacles.size(); ++i)
            add_obstacle(scene_.obstacles[i], fmt::format("/obstacles/{}", i));
        for (std::size_t i = 0; i < scene_.handles.size(); ++i)
            add_handle(scene_.handles[i], fmt::format("/handles/{}", i));
        for (std::size_t i = 0; i < scene_.loads.size(); ++i)
            add_load(scene_.loads[i], fmt::format("/loads/{}", i));
        model_.hierarchy = scene_.hierarchy;
        set_parameters(scene_, model_);
        expect_no_flood_of_faces();
        expect_no_intersections();
        for (std::size_t b = 0; b < model_.bodies.size(); ++b)
            expect_within_limit(model_.bodies[b], fmt::format("/bodies/{}", b));
        return std::move(model_);
    }

private:
    /// Adds the mesh to the model; returns the vertices and faces it became.
    std::pair<Range, Range> append(const TriangleMesh& mesh, const Positions& start) {
        const int vertices = model_.mesh.vertex_count(), faces = model_.mesh.face_count();
        append_mesh(model_.mesh, mesh);
        model_.start.conservativeResize(3, model_.mesh.vertex_count());
        model_.start.rightCols(start.cols()) = start;
        return {{vertices, model_.mesh.vertex_count()}, {faces, model_.mesh.face_count()}};
    }

    void add_body(const BodySpec& spec, const std::string& pointer) {
        if (spec.material.law != MaterialLaw::isotropic)
            throw scene_.error_at(pointer + "/material", "this is an orthotropic cloth for the method rmtr",
                                  "give another material, such as \"denim\", or the method rmtr");
        TriangleMesh mesh = load_mesh(scene_, spec.mesh, spec.transform, pointer + "/mesh", context_);
        expect_usable(scene_, mesh, spec.mesh, pointer + "/mesh", false);
        placed_.push_back(mesh);
        Positions start = mesh.positions;
        if (spec.rest.kind == RestSpec::Kind::mesh)
            mesh.positions = same_mesh(mesh, spec.rest.mesh, spec.transform, pointer + "/rest/mesh");
        if (spec.start)
            start = same_mesh(mesh, *spec.start, spec.transform, pointer + "/start");

        Body& body = model_.bodies.emplace_back();
        body.name = spec.name;
        std::tie(body.vertices, body.faces) = append(mesh, start);
        body.flat_rest_angles = spec.rest.kind == RestSpec::Kind::flat_angles;
    }

    Positions same_mesh(const TriangleMesh& mesh, const MeshSpec& spec, const TransformSpec& transform,
                        const std::string& pointer) {
        const TriangleMesh other = load_mesh(scene_, spec, transform, pointer, context_);
        expect_same_connectivity(scene_, mesh, other, pointer);
        expect_usable(scene_, other, spec, pointer, false);
        return other.positions;
    }

    void add_obstacle(const ObstacleSpec& spec, const std::string& pointer) {
        const TriangleMesh mesh = load_mesh(scene_, spec.mesh, spec.transform, pointer + "/mesh", context_);
        expect_usable(scene_, mesh, spec.mesh, pointer + "/mesh", true);
        Obstacle& obstacle = model_.obstacles.emplace_back();
        obstacle.name = spec.name;
        std::tie(obstacle.vertices, obstacle.faces) = append(mesh, mesh.positions);
        obstacle.progressive = spec.progressive;
    }

    int body_number(const std::string& name) const {
        const auto found = std::find_if(model_.bodies.begin(), model_.bodies.end(),
                                        [&](const Body& body) { return body.name == name; });
        return static_cast<int>(found - model_.bodies.begin());
    }

    /// The selected vertices of a body, in the model's numbering.
    std::vector<int> selected(int body, const std::optional<SelectSpec>& select, const std::string& pointer) const {
        const TriangleMesh& mesh = placed_[static_cast<std::size_t>(body)];
        std::vector<int> vertices = select ? select_vertices(scene_, *select, mesh, pointer) : used_vertices(mesh);
        for (int& v : vertices)
            v += model_.bodies[static_cast<std::size_t>(body)].vertices.begin;
        return vertices;
    }

    void add_handle(const HandleSpec& spec, const std::string& pointer) {
        Handle handle;
        handle.name = spec.name;
        handle.body = body_number(spec.body);
        handle.vertices = selected(handle.body, spec.select, pointer + "/select");
        handle.axes = spec.axes;
        expect_free_axes(handle, pointer);
        model_.handles.push_back(std::move(handle));
    }

    /// A vertex may belong to several handles as long as no axis is prescribed twice.
    void expect_free_axes(const Handle& handle, const std::string& pointer) {
        const int number = static_cast<int>(model_.handles.size());
        for (int v : handle.vertices) {
            auto& owners = owners_.try_emplace(v, std::array{-1, -1, -1}).first->second;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                if (!handle.axes[axis])
                    continue;
                if (owners[axis] >= 0)
                    throw scene_.error_at(
                        pointer,
                        fmt::format("vertex {} of \"{}\" is prescribed along {} by \"{}\" too",
                                    v - model_.bodies[static_cast<std::size_t>(handle.body)].vertices.begin,
                                    model_.bodies[static_cast<std::size_t>(handle.body)].name, "xyz"[axis],
                                    model_.handles[static_cast<std::size_t>(owners[axis])].name),
                        "select other vertices or other axes");
                owners[axis] = number;
            }
        }
    }

    void add_load(const LoadSpec& spec, const std::string& pointer) {
        Load& load = model_.loads.emplace_back();
        load.body = body_number(spec.body);
        load.vertices = selected(load.body, spec.select, pointer + "/select");
    }

    /// Each level made by subdivision has four times the faces.
    void expect_no_flood_of_faces() const {
        constexpr double most = 2e7;
        const HierarchySettings& hierarchy = model_.hierarchy;
        const double faces = model_.bodies.back().faces.end * std::pow(4.0, hierarchy.levels - 1);
        if (hierarchy.source == HierarchySource::loop && faces > most)
            throw scene_.error_at(
                "/hierarchy/levels",
                fmt::format("the finest level would have {:.3g} faces, more than {:.3g}", faces, most),
                "give fewer levels: by the source loop each has four times the faces of the one before");
    }

    /// Where everything stands when the run begins: obstacles are where their script has them at t = 0.
    Positions scripted_start() const {
        Positions start = model_.start;
        for (const Obstacle& obstacle : model_.obstacles)
            for (int v = obstacle.vertices.begin; v < obstacle.vertices.end; ++v)
                start.col(v) = obstacle.motion.apply(start.col(v), 0.0);
        return start;
    }

    void expect_no_intersections() const {
        expect_no_intersections(model_.mesh.positions, "at rest");
        if (const Positions start = scripted_start(); start != model_.mesh.positions)
            expect_no_intersections(start, "at the start");
    }

    void expect_no_intersections(const Positions& positions, const char* when) const {
        constexpr int most = 10000;
        const std::vector<int> part = model_.face_parts();
        const auto of_obstacles = [&](int a, int b) {
            return model_.is_obstacle(part[static_cast<std::size_t>(a)]) &&
                   model_.is_obstacle(part[static_cast<std::size_t>(b)]);
        };
        const auto pairs = intersecting_pairs(positions, model_.mesh.faces, of_obstacles, most);
        if (pairs.empty())
            return;
        std::string places;
        for (std::size_t i = 0; i < std::min<std::size_t>(3, pairs.size()); ++i)
            places += (i > 0 ? ", " : "") + meeting(positions, pairs[i]);
        const InputError error = scene_.error_at(part_pointer(part[static_cast<std::size_t>(pairs.front()[0])]),
                                                 fmt::format("{}{} pairs of faces intersect {}, first {}",
                                                             static_cast<int>(pairs.size()) == most ? "at least " : "",
                                                             pairs.size(), when, places),
                                                 "separate the surfaces, by `transform` or in the meshes");
        throw IntersectingSurfaces(error, positions, model_.mesh.faces, pairs, part);
    }

    std::string meeting(const Positions& positions, const std::array<int, 2>& pair) const {
        const auto& faces = model_.mesh.faces;
        const Vec3 place = meeting_place(positions, faces[static_cast<std::size_t>(pair[0])],
                                         faces[static_cast<std::size_t>(pair[1])]);
        return fmt::format("{} and {} near ({:.6g}, {:.6g}, {:.6g})", face_name(pair[0]), face_name(pair[1]), place.x(),
                           place.y(), place.z());
    }

    void expect_within_limit(const Body& body, const std::string& pointer) const {
        if (!body.material.strain_limit)
            return;
        const auto first = model_.mesh.faces.begin() + body.faces.begin;
        const RestTriangles triangles(model_.mesh.positions, {first, first + body.faces.size()});
        int worst = 0;
        for (int f = 0; f < triangles.count(); ++f)
            if (triangles.principal_stretches(f, model_.start)[0] >
                triangles.principal_stretches(worst, model_.start)[0])
                worst = f;
        const double stretch = triangles.principal_stretches(worst, model_.start)[0];
        if (stretch < *body.material.strain_limit)
            return;
        const Vec3 place = model_.start.col(triangles.face(worst)[0]);
        throw scene_.error_at(
            pointer,
            fmt::format("{} is stretched to {:.6g} at the start, near ({:.6g}, {:.6g}, {:.6g}), and the strain "
                        "limit is {:.6g}",
                        face_name(body.faces.begin + worst), stretch, place.x(), place.y(), place.z(),
                        *body.material.strain_limit),
            "give a `start` that is stretched less, or a higher `strain_limit`");
    }

    std::string part_pointer(int part) const {
        const int bodies = static_cast<int>(model_.bodies.size());
        return part < bodies ? fmt::format("/bodies/{}", part) : fmt::format("/obstacles/{}", part - bodies);
    }

    std::string face_name(int face) const {
        for (const Body& body : model_.bodies)
            if (body.faces.contains(face))
                return fmt::format("face {} of \"{}\"", face - body.faces.begin, body.name);
        for (const Obstacle& obstacle : model_.obstacles)
            if (obstacle.faces.contains(face))
                return fmt::format("face {} of \"{}\"", face - obstacle.faces.begin, obstacle.name);
        return fmt::format("face {}", face);
    }

    const Scene& scene_;
    Context& context_;
    Model model_;
    std::vector<TriangleMesh> placed_;         ///< bodies' meshes, where selections are made
    std::map<int, std::array<int, 3>> owners_; ///< per prescribed vertex and axis: number of its handle
};

} // namespace

Model build_model(const Scene& scene, Context& context) {
    return ModelBuilder(scene, context).build();
}

} // namespace plisse
