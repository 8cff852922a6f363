#include <plisse/drive/expanding_mesh.h>

#include <algorithm>

#include <plisse/drive/refinement_targets.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

int id_count(const Hierarchy& hierarchy) {
    return static_cast<int>(hierarchy.finest().rest.cols()) + static_cast<int>(hierarchy.collapses.size());
}

double mean_edge_length(const HierarchyLevel& mesh, const Positions& x) {
    double sum = 0;
    for (const Face& face : mesh.faces)
        for (std::size_t k = 0; k < 3; ++k)
            sum += (x.col(face[k]) - x.col(face[(k + 1) % 3])).norm();
    return mesh.faces.empty() ? 1.0 : sum / (3.0 * static_cast<double>(mesh.faces.size()));
}

} // namespace

ExpandingMesh::ExpandingMesh(const Discretization& discretization, int from, const Positions& x, double t)
    : discretization_(discretization), faces_(discretization.hierarchy(), from),
      positions_(Positions::Zero(3, id_count(discretization.hierarchy()))), rest_(positions_), targets_(positions_),
      obstacle_(at(static_cast<int>(positions_.cols())), 0),
      grid_(mean_edge_length(discretization.mesh(from), x), faces_.face_id_count()) {
    const HierarchyLevel& coarse = discretization.mesh(from);
    for (std::size_t v = 0; v < coarse.vertex_ids.size(); ++v) {
        positions_.col(coarse.vertex_ids[v]) = x.col(static_cast<int>(v));
        rest_.col(coarse.vertex_ids[v]) = coarse.rest.col(static_cast<int>(v));
        obstacle_[at(coarse.vertex_ids[v])] = discretization.model().is_obstacle(coarse.part[v]);
    }
    set_targets(from, refinement_targets(discretization, from, x, t));
    update_boxes(coarse.face_ids, [&](int v) { return Box{position(v), position(v)}; });
}

void ExpandingMesh::set_targets(int from, const Positions& next_level) {
    const HierarchyLevel& coarse = discretization_.mesh(from);
    const HierarchyLevel& fine = discretization_.mesh(from + 1);
    for (int v = 0; v < next_level.cols(); ++v) {
        const int id = fine.vertex_ids[at(v)];
        targets_.col(id) = next_level.col(v);
        rest_.col(id) = fine.rest.col(v);
        obstacle_[at(id)] = discretization_.model().is_obstacle(fine.part[at(v)]);
    }
    std::vector<int> records;
    for (const auto& batch : coarse.batches)
        records.insert(records.end(), batch.begin(), batch.end());
    std::sort(records.begin(), records.end());
    for (int c : records) {
        // A vertex that exists only between the levels heads for where the two it splits into will be.
        const Collapse& collapse = discretization_.hierarchy().collapses[at(c)];
        const Vec3 edge = collapse.rest_j - collapse.rest_i;
        const double length_squared = edge.squaredNorm();
        const double share = length_squared > 0
                                 ? std::clamp(edge.dot(collapse.rest_k - collapse.rest_i) / length_squared, 0.0, 1.0)
                                 : 0.5;
        targets_.col(collapse.k) = (1 - share) * targets_.col(collapse.i) + share * targets_.col(collapse.j);
        rest_.col(collapse.i) = collapse.rest_i;
        rest_.col(collapse.j) = collapse.rest_j;
        rest_.col(collapse.k) = collapse.rest_k;
        obstacle_[at(collapse.k)] = obstacle_[at(collapse.i)];
    }
}

void ExpandingMesh::split(const Collapse& collapse) {
    faces_.expand(collapse);
    positions_.col(collapse.i) = positions_.col(collapse.k);
    positions_.col(collapse.j) = positions_.col(collapse.k);
}

void ExpandingMesh::merge(const Collapse& collapse) {
    faces_.collapse(collapse);
    for (int f : collapse.dead_faces)
        if (grid_.contains(f))
            grid_.remove(f);
    positions_.col(collapse.k) = positions_.col(collapse.i);
}

Positions ExpandingMesh::level_positions(int level) const {
    const std::vector<int>& ids = discretization_.mesh(level).vertex_ids;
    Positions x(3, static_cast<int>(ids.size()));
    for (std::size_t v = 0; v < ids.size(); ++v)
        x.col(static_cast<int>(v)) = positions_.col(ids[v]);
    return x;
}

} // namespace plisse
