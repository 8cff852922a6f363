#include <plisse/contact/collision_mesh.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include <Eigen/Geometry>

namespace plisse {

CollisionMesh::CollisionMesh(Positions rest_positions, std::vector<Face> mesh_faces, std::vector<int> parts,
                             std::vector<std::uint8_t> obstacles)
    : rest(std::move(rest_positions)), faces(std::move(mesh_faces)), part(std::move(parts)),
      obstacle(std::move(obstacles)) {
    assert(part.size() == static_cast<std::size_t>(rest.cols()));
    connectivity = Connectivity(static_cast<int>(rest.cols()), faces);
    edges = connectivity.edges();
    vertex_area.assign(part.size(), 0);
    edge_area.assign(edges.size(), 0);
    face_area.resize(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto& [a, b, c] = faces[f];
        face_area[f] = 0.5 * Vec3(rest.col(b) - rest.col(a)).cross(rest.col(c) - rest.col(a)).norm();
        for (std::size_t k = 0; k < 3; ++k) {
            vertex_area[static_cast<std::size_t>(faces[f][k])] += face_area[f] / 3;
            edge_area[static_cast<std::size_t>(connectivity.face_edges()[f][k])] += face_area[f] / 3;
        }
    }
    largest_vertex_area.assign(obstacle.size(), 0);
    for (int v = 0; v < connectivity.vertex_count(); ++v) {
        if (!connectivity.vertex_faces(v).empty())
            vertices.push_back(v);
        double& largest = largest_vertex_area[static_cast<std::size_t>(part[static_cast<std::size_t>(v)])];
        largest = std::max(largest, vertex_area[static_cast<std::size_t>(v)]);
    }
}

} // namespace plisse
