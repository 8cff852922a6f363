#pragma once

#include <vector>

#include <plisse/decimate/dynamic_faces.h>

namespace plisse {

/// Unit normal and quality q = 4 sqrt(3) area / (sum of squared edges), 1 for an equilateral triangle. Both are zero
/// for a triangle without area.
struct FaceShape {
    Vec3 normal = Vec3::Zero();
    double quality = 0;
};
FaceShape face_shape(const Vec3& p, const Vec3& q, const Vec3& r);

/// The faces around an edge (i, j) and what becomes of them when the edge collapses to k.
struct Patch {
    int i = -1, j = -1, k = -1;
    std::vector<int> dead_faces;             ///< faces on the edge, ascending
    std::vector<int> faces_of_i, faces_of_j; ///< the other faces, ascending
    std::vector<int> ring;                   ///< neighbours of i and j, ascending
    int neighbours_of_i = 0, neighbours_of_j = 0;
    int common_neighbours = 0;
    /// Of a boundary edge: the next boundary vertices beyond i and beyond j.
    int beyond_i = -1, beyond_j = -1;
    std::vector<Face> after;             ///< corners of faces_of_i, then of faces_of_j, with k
    std::vector<FaceShape> after_shapes; ///< filled by the one who places k

    bool is_boundary_edge() const { return dead_faces.size() == 1; }
    int face_count() const { return static_cast<int>(dead_faces.size() + after.size()); }
    /// Id of face number n of `after`.
    int after_face(std::size_t n) const {
        return n < faces_of_i.size() ? faces_of_i[n] : faces_of_j[n - faces_of_i.size()];
    }
    /// Place of a vertex in the ring.
    int ring_index(int vertex) const;

    /// Becomes the patch of edge (i, j). Keeps its memory.
    void gather(const DynamicFaces& faces, int edge_i, int edge_j, int merged_k);

private:
    struct Neighbour {
        int vertex;
        int faces; // that hold it together with the centre
    };
    static void collect(const DynamicFaces& faces, int center, std::vector<Neighbour>& neighbours);
    static int boundary_neighbour(const std::vector<Neighbour>& neighbours, int other_than);

    std::vector<Neighbour> around_i_, around_j_;
};

} // namespace plisse
