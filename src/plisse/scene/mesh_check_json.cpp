#include <plisse/scene/mesh_check_json.h>

#include <nlohmann/json.hpp>

namespace plisse {

nlohmann::ordered_json counts_json(const MeshCheck& check) {
    return {{"vertices", check.vertices},
            {"faces", check.faces},
            {"components", check.components},
            {"boundary_loops", check.boundary_loops},
            {"euler_characteristic", check.euler_characteristic},
            {"sheets", check.sheets},
            {"unreferenced_vertices", check.unreferenced_vertices},
            {"non_manifold_edges", check.non_manifold_edges.size()},
            {"inconsistent_edges", check.inconsistent_edges.size()},
            {"non_manifold_vertices", check.non_manifold_vertices.size()},
            {"degenerate_faces", check.degenerate_faces.size()},
            {"duplicate_faces", check.duplicate_faces.size()},
            {"intersecting_face_pairs", check.intersecting_faces.size()}};
}

} // namespace plisse
