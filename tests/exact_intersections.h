#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include <plisse/decimate/hierarchy.h>

namespace plisse {

/// Intersecting pairs by exact constructions, sharing no code with the solver: what two triangles have in common must
/// be nothing, or just their shared corner or edge. Pairs of two faces whose flag is set do not count.
inline int count_intersections(const Positions& x, const std::vector<Face>& faces,
                               const std::vector<std::uint8_t>& on_obstacle) {
    using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
    std::vector<CGAL::Bbox_3> boxes;
    for (const Face& f : faces) {
        CGAL::Bbox_3 box;
        for (int v : f)
            box += CGAL::Bbox_3(x(0, v), x(1, v), x(2, v), x(0, v), x(1, v), x(2, v));
        boxes.push_back(box);
    }
    const auto triangle = [&](const Face& f) {
        const auto point = [&](int v) { return Kernel::Point_3(x(0, v), x(1, v), x(2, v)); };
        return Kernel::Triangle_3(point(f[0]), point(f[1]), point(f[2]));
    };
    const auto intersect = [&](const Face& a, const Face& b) {
        const Kernel::Triangle_3 ta = triangle(a), tb = triangle(b);
        if (!CGAL::do_intersect(ta, tb))
            return false;
        const auto shared =
            std::count_if(a.begin(), a.end(), [&](int v) { return std::find(b.begin(), b.end(), v) != b.end(); });
        const auto common = CGAL::intersection(ta, tb);
        const bool harmless = (shared == 1 && boost::get<Kernel::Point_3>(&*common)) ||
                              (shared == 2 && boost::get<Kernel::Segment_3>(&*common));
        return !harmless;
    };
    std::vector<std::size_t> order(faces.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return boxes[a].xmin() < boxes[b].xmin(); });
    int count = 0;
    for (auto a = order.begin(); a != order.end(); ++a)
        for (auto b = a + 1; b != order.end() && boxes[*b].xmin() <= boxes[*a].xmax(); ++b)
            if (!(on_obstacle[*a] && on_obstacle[*b]) && CGAL::do_overlap(boxes[*a], boxes[*b]))
                count += intersect(faces[*a], faces[*b]);
    return count;
}

/// The same for a state of one level of a hierarchy whose first `bodies` parts are bodies.
inline int count_intersections(const Positions& x, const HierarchyLevel& level, int bodies) {
    std::vector<std::uint8_t> on_obstacle;
    for (const Face& f : level.faces)
        on_obstacle.push_back(level.part[static_cast<std::size_t>(f[0])] >= bodies);
    return count_intersections(x, level.faces, on_obstacle);
}

} // namespace plisse
