#include <plisse/decimate/patch.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace plisse {

FaceShape face_shape(const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 a = q - p, b = r - p;
    const Vec3 normal = a.cross(b);
    const double twice_area = normal.norm();
    if (!(twice_area > 0))
        return {};
    const double edges_squared = a.squaredNorm() + b.squaredNorm() + (r - q).squaredNorm();
    return {normal / twice_area, 2 * std::sqrt(3.0) * twice_area / edges_squared};
}

int Patch::ring_index(int vertex) const {
    return static_cast<int>(std::lower_bound(ring.begin(), ring.end(), vertex) - ring.begin());
}

void Patch::collect(const DynamicFaces& faces, int center, std::vector<Neighbour>& neighbours) {
    neighbours.clear();
    for (int f : faces.vertex_faces(center))
        for (int v : faces.face(f)) {
            if (v == center)
                continue;
            const auto known = std::find_if(neighbours.begin(), neighbours.end(),
                                            [v](const Neighbour& neighbour) { return neighbour.vertex == v; });
            if (known == neighbours.end())
                neighbours.push_back({v, 1});
            else
                ++known->faces;
        }
}

int Patch::boundary_neighbour(const std::vector<Neighbour>& neighbours, int other_than) {
    for (const Neighbour& neighbour : neighbours)
        if (neighbour.faces == 1 && neighbour.vertex != other_than)
            return neighbour.vertex;
    return -1;
}

void Patch::gather(const DynamicFaces& faces, int edge_i, int edge_j, int merged_k) {
    i = edge_i;
    j = edge_j;
    k = merged_k;
    dead_faces.clear();
    faces_of_i.clear();
    faces_of_j.clear();
    after.clear();
    const auto add_after = [&](int f, int from, std::vector<int>& list) {
        list.push_back(f);
        Face& corners = after.emplace_back(faces.face(f));
        *std::find(corners.begin(), corners.end(), from) = k;
    };
    const auto holds = [&](int f, int v) {
        const Face& corners = faces.face(f);
        return corners[0] == v || corners[1] == v || corners[2] == v;
    };
    for (int f : faces.vertex_faces(i)) {
        if (holds(f, j))
            dead_faces.push_back(f);
        else
            add_after(f, i, faces_of_i);
    }
    for (int f : faces.vertex_faces(j))
        if (!holds(f, i))
            add_after(f, j, faces_of_j);

    collect(faces, i, around_i_);
    collect(faces, j, around_j_);
    neighbours_of_i = static_cast<int>(around_i_.size());
    neighbours_of_j = static_cast<int>(around_j_.size());
    ring.clear();
    for (const auto* around : {&around_i_, &around_j_})
        for (const Neighbour& neighbour : *around)
            if (neighbour.vertex != i && neighbour.vertex != j)
                ring.push_back(neighbour.vertex);
    std::sort(ring.begin(), ring.end());
    const auto distinct = std::unique(ring.begin(), ring.end());
    common_neighbours = static_cast<int>(ring.end() - distinct);
    ring.erase(distinct, ring.end());
    beyond_i = is_boundary_edge() ? boundary_neighbour(around_i_, j) : -1;
    beyond_j = is_boundary_edge() ? boundary_neighbour(around_j_, i) : -1;
}

} // namespace plisse
