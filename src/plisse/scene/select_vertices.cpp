#include <plisse/scene/select_vertices.h>

#include <algorithm>

#include <fmt/core.h>

#include <plisse/mesh/connectivity.h>

namespace plisse {

namespace {

/// What each kind of selection takes of one mesh.
struct Selector {
    const Scene& scene;
    const TriangleMesh& mesh;
    const std::string& pointer;

    template <typename Inside>
    std::vector<int> vertices_that(const Inside& inside) const {
        std::vector<int> taken;
        for (int v : used_vertices(mesh))
            if (inside(mesh.positions.col(v)))
                taken.push_back(v);
        return taken;
    }

    std::vector<int> operator()(const BoxSelection& box) const {
        return vertices_that([&](const auto& p) {
            return (p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all();
        });
    }

    std::vector<int> operator()(const SphereSelection& sphere) const {
        return vertices_that([&](const auto& p) { return (p - sphere.center).norm() <= sphere.radius; });
    }

    std::vector<int> operator()(const VertexSelection& selection) const {
        std::vector<int> taken = selection.vertices;
        std::sort(taken.begin(), taken.end());
        taken.erase(std::unique(taken.begin(), taken.end()), taken.end());
        const std::vector<int> used = used_vertices(mesh);
        for (int v : taken)
            if (!std::binary_search(used.begin(), used.end(), v))
                throw scene.error_at(pointer + "/vertices", fmt::format("the mesh has no face with a vertex {}", v),
                                     fmt::format("give vertices from 0 to {} that faces use", mesh.vertex_count() - 1));
        return taken;
    }

    std::vector<int> operator()(const LoopSelection& selection) const {
        const auto loops = boundary_pieces(Connectivity(mesh.vertex_count(), mesh.faces));
        if (selection.loop >= static_cast<int>(loops.size()))
            throw scene.error_at(pointer + "/boundary_loop",
                                 fmt::format("there is no loop {}: the mesh has {}", selection.loop, loops.size()),
                                 loops.empty() ? "select in another way: the mesh is closed"
                                               : fmt::format("give a number from 0 to {}", loops.size() - 1));
        return loops[static_cast<std::size_t>(selection.loop)];
    }
};

} // namespace

std::vector<int> select_vertices(const Scene& scene, const SelectSpec& select, const TriangleMesh& mesh,
                                 const std::string& pointer) {
    std::vector<int> taken = std::visit(Selector{scene, mesh, pointer}, select);
    if (taken.empty()) {
        const Vec3 low = mesh.positions.rowwise().minCoeff(), high = mesh.positions.rowwise().maxCoeff();
        throw scene.error_at(pointer, "no vertex is selected",
                             fmt::format("after its transform the body lies between ({:.4g}, {:.4g}, {:.4g}) and "
                                         "({:.4g}, {:.4g}, {:.4g})",
                                         low.x(), low.y(), low.z(), high.x(), high.y(), high.z()));
    }
    return taken;
}

std::vector<int> used_vertices(const TriangleMesh& mesh) {
    std::vector<bool> used(static_cast<std::size_t>(mesh.vertex_count()), false);
    for (const Face& face : mesh.faces)
        for (int v : face)
            used[static_cast<std::size_t>(v)] = true;
    std::vector<int> vertices;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (used[static_cast<std::size_t>(v)])
            vertices.push_back(v);
    return vertices;
}

} // namespace plisse
