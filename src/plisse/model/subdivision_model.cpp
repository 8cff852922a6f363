#include <plisse/model/subdivision_model.h>

namespace plisse {

TriangleMesh limit_surface(const SubdivisionLevels& levels, int level) {
    const LimitPoints points = levels.limit_points(level);
    TriangleMesh surface;
    surface.positions = levels.rest(level) * points.weights.transpose();
    for (const Quad& quad : points.quads) {
        surface.faces.push_back({quad[0], quad[1], quad[2]});
        surface.faces.push_back({quad[0], quad[2], quad[3]});
    }
    return surface;
}

std::vector<Vec3> SubdivisionModel::warp_on(int level) const {
    if (warp.size() == 1)
        return warp;
    const std::size_t parts = std::size_t{1} << (2 * level); // of each face of level 0, which are in its order
    std::vector<Vec3> directions;
    for (const Vec3& direction : warp)
        directions.insert(directions.end(), parts, direction);
    return directions;
}

Positions SubdivisionModel::obstacles_at(double t) const {
    Positions moved = obstacles.positions;
    for (int v = 0; v < obstacles.vertex_count(); ++v) {
        const int obstacle = obstacle_of_vertex[static_cast<std::size_t>(v)];
        moved.col(v) = obstacle_motions[static_cast<std::size_t>(obstacle)].apply(obstacles.positions.col(v), t);
    }
    return moved;
}

} // namespace plisse
