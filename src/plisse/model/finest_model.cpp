#include <plisse/model/finest_model.h>

#include <algorithm>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// The numbers, which ascend, that equal `part`.
Range range_of(const std::vector<int>& parts, int part) {
    const auto [begin, end] = std::equal_range(parts.begin(), parts.end(), part);
    return {static_cast<int>(begin - parts.begin()), static_cast<int>(end - parts.begin())};
}

/// Finest vertices that lie between some of level 0 only.
std::vector<int> vertices_between(const HierarchyLevel& coarsest, const std::vector<int>& vertices) {
    std::vector<bool> chosen(coarsest.part.size(), false);
    for (int v : vertices)
        chosen[at(v)] = true;
    std::vector<int> result;
    for (std::size_t v = 0; v < coarsest.to_finest.size(); ++v) {
        const Anchor& anchor = coarsest.to_finest[v];
        bool all = anchor.face >= 0;
        for (int k = 0; k < 3 && all; ++k)
            all = anchor.weights[k] == 0 || chosen[at(coarsest.faces[at(anchor.face)][at(k)])];
        if (all)
            result.push_back(static_cast<int>(v));
    }
    return result;
}

} // namespace

Model finest_model(const Model& model, const Hierarchy& hierarchy, const Positions& start,
                   const std::vector<std::vector<int>>& handles_of_label) {
    const HierarchyLevel &coarsest = hierarchy.levels.front(), &finest = hierarchy.finest();
    Model result = model;
    result.mesh = {finest.rest, finest.faces, {}};
    result.start = start;

    std::vector<int> face_part;
    for (const Face& face : finest.faces)
        face_part.push_back(finest.part[at(face[0])]);
    int part = 0;
    const auto place = [&](auto& body_or_obstacle) {
        body_or_obstacle.vertices = range_of(finest.part, part);
        body_or_obstacle.faces = range_of(face_part, part);
        ++part;
    };
    for (Body& body : result.bodies)
        place(body);
    for (Obstacle& obstacle : result.obstacles)
        place(obstacle);
    for (const Obstacle& obstacle : model.obstacles) // before their motion, unlike the hierarchy's
        for (int v = obstacle.vertices.begin; v < obstacle.vertices.end; ++v) {
            const int id = coarsest.vertex_ids[at(v)];
            result.mesh.positions.col(id) = result.start.col(id) = model.mesh.positions.col(v);
        }

    for (Handle& handle : result.handles)
        handle.vertices.clear();
    for (std::size_t v = 0; v < finest.label.size(); ++v)
        if (finest.label[v] >= 0)
            for (int h : handles_of_label[at(finest.label[v])])
                result.handles[at(h)].vertices.push_back(static_cast<int>(v));
    for (Load& load : result.loads)
        load.vertices = vertices_between(coarsest, load.vertices);
    return result;
}

} // namespace plisse
