#include <plisse/mesh/quad_connectivity.h>

#include <algorithm>
#include <tuple>

namespace plisse {

QuadConnectivity::QuadConnectivity(int vertex_count, std::span<const Quad> faces)
    : twin_(4 * faces.size(), -1), edge_(4 * faces.size(), -1), start_(static_cast<std::size_t>(vertex_count), -1) {
    for (const Quad& face : faces)
        from_.insert(from_.end(), face.begin(), face.end());
    std::vector<std::tuple<int, int, int>> sides; // lower end, higher end, side
    for (int h = 0; h < side_count(); ++h)
        sides.emplace_back(std::min(from(h), to(h)), std::max(from(h), to(h)), h);
    std::sort(sides.begin(), sides.end());
    for (std::size_t s = 1; s < sides.size(); ++s) {
        const auto& [a, b, h] = sides[s - 1];
        const auto& [c, d, g] = sides[s];
        if (a == c && b == d) {
            twin_[static_cast<std::size_t>(h)] = g;
            twin_[static_cast<std::size_t>(g)] = h;
        }
    }
    for (int h = 0; h < side_count(); ++h) {
        const bool first = twin(h) < 0 || twin(h) > h;
        edge_[static_cast<std::size_t>(h)] = first ? edge_count() : edge(twin(h));
        if (first)
            edge_sides_.push_back(h);
        int& start = start_[static_cast<std::size_t>(from(h))];
        if (start < 0 || twin(h) < 0)
            start = h;
    }
}

bool QuadConnectivity::is_boundary_vertex(int vertex) const {
    const int start = start_[static_cast<std::size_t>(vertex)];
    return start >= 0 && twin(start) < 0;
}

std::vector<int> QuadConnectivity::star(int vertex) const {
    std::vector<int> sides;
    const int start = start_[static_cast<std::size_t>(vertex)];
    for (int h = start; h >= 0 && (sides.empty() || h != start); h = rotated(h))
        sides.push_back(h);
    return sides;
}

} // namespace plisse
