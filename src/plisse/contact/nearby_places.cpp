#include <plisse/contact/nearby_places.h>

#include <algorithm>
#include <cassert>
#include <functional>

#include <plisse/contact/candidates.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// The vertices of the face's feature that the closest point lies in.
std::array<int, 3> feature_corners(const std::array<int, 4>& vertices, const Separation& separation) {
    std::array<int, 3> corners = {-1, -1, -1};
    std::size_t count = 0;
    for (int k = 1; k < 4; ++k)
        if ((separation.corners >> k & 1) != 0)
            corners[count++] = vertices[at(k)];
    std::sort(corners.begin(), corners.end(), std::greater());
    return corners;
}

/// Whether the closest point lies in the feature of the face's given corners, one bit each.
bool lies_in(const Separation& separation, int corners) {
    return ((separation.corners >> 1) & ~corners) == 0;
}

PairRange least_of(const PairRange& a, const PairRange& b) {
    return {std::min(a.thickness, b.thickness), std::min(a.least, b.least), std::min(a.activation, b.activation)};
}

class PlaceFinder {
public:
    PlaceFinder(const CollisionMesh& mesh, const Positions& x, std::span<const NearTriangle> near,
                std::vector<NearPlace>& places)
        : mesh_(mesh), x_(x), near_(near), places_(places) {}

    void find() {
        places_.clear();
        for (const NearTriangle& triangle : near_) {
            add(triangle, triangle.range, triangle.separation, 1);
            for (int k = 0; k < 3 && near_.size() > 1; ++k) {
                take_off_edge(triangle, k);
                add_vertex(triangle, k);
            }
        }
        std::erase_if(places_, [](const NearPlace& place) { return place.count == 0; });
    }

private:
    const NearTriangle* find_near(int face) const {
        const auto found = std::find_if(near_.begin(), near_.end(), [&](const auto& t) { return t.face == face; });
        return found == near_.end() ? nullptr : &*found;
    }

    bool has_point(int face) const { return mesh_.has_corner(face, near_.front().vertices[0]); }

    void add(const NearTriangle& triangle, const PairRange& range, const Separation& separation, int count) {
        if (separation.squared_distance >= range.activation * range.activation)
            return;
        const auto corners = feature_corners(triangle.vertices, separation);
        for (NearPlace& place : places_)
            if (place.corners == corners && place.range.activation == range.activation &&
                place.range.least == range.least) {
                place.count += count;
                return;
            }
        places_.push_back({triangle.face, triangle.vertices, range, separation, count, corners});
    }

    /// Edge k of a triangle, by the lowest of its faces that are near, once for each other. A face that is not near has
    /// no point nearer than the edge.
    void take_off_edge(const NearTriangle& triangle, int k) {
        const int edge = mesh_.connectivity.face_edges()[at(triangle.face)][at(k)];
        PairRange range = triangle.range;
        int others = 0;
        for (const int face : mesh_.connectivity.edge_faces(edge)) {
            const NearTriangle* other = face == triangle.face ? nullptr : find_near(face);
            if (!other)
                continue;
            if (face < triangle.face)
                return;
            range = least_of(range, other->range);
            ++others;
        }
        if (others == 0)
            return;
        const int corners = 1 << k | 1 << (k + 1) % 3;
        const Separation separation = lies_in(triangle.separation, corners)
                                          ? triangle.separation
                                          : separate_from_border(gather(x_, triangle.vertices), k);
        add(triangle, range, separation, -others);
    }

    /// Corner k of a triangle, by the first face around it.
    void add_vertex(const NearTriangle& triangle, int k) {
        const int vertex = triangle.vertices[at(k + 1)];
        const double activation = triangle.range.activation;
        if ((x_.col(vertex) - x_.col(triangle.vertices[0])).squaredNorm() >= activation * activation)
            return;
        PairRange range = triangle.range;
        int count = 1;
        for (const int face : mesh_.connectivity.vertex_faces(vertex)) {
            if (has_point(face))
                continue;
            const NearTriangle* near = face < triangle.face ? nullptr : find_near(face);
            if (!near)
                return;
            range = least_of(range, near->range);
            --count;
            count += inner_edges(face, vertex);
        }
        if (count == 0)
            return;
        const Separation separation = lies_in(triangle.separation, 1 << k)
                                          ? triangle.separation
                                          : separate_from_corner(gather(x_, triangle.vertices), k);
        add(triangle, range, separation, count);
    }

    /// How many edges at a vertex a face has in common with a higher face that does not have the point as a corner.
    int inner_edges(int face, int vertex) const {
        int count = 0;
        for (const int edge : mesh_.connectivity.face_edges()[at(face)]) {
            const Edge& ends = mesh_.edges[at(edge)];
            const auto sides = mesh_.connectivity.edge_faces(edge);
            count +=
                (ends[0] == vertex || ends[1] == vertex) &&
                std::any_of(sides.begin(), sides.end(), [&](int other) { return other > face && !has_point(other); });
        }
        return count;
    }

    const CollisionMesh& mesh_;
    const Positions& x_;
    std::span<const NearTriangle> near_;
    std::vector<NearPlace>& places_;
};

} // namespace

void find_nearby_places(const CollisionMesh& mesh, const Positions& x, std::span<const NearTriangle> near,
                        std::vector<NearPlace>& places) {
    assert(!near.empty());
    PlaceFinder(mesh, x, near, places).find();
}

} // namespace plisse
