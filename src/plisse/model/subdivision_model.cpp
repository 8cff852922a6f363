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

} // namespace plisse
