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
///
/// Curve edges, those of one face or of more than two, cut the patch into sheets, each flattened by itself: the sheets
/// with faces on the edge are numbered 0, 1, ...; faces of others are at an end that keeps its place, and rest. A ring
/// vertex has one place in each sheet that it is in.
struct Patch {
    static constexpr int at_rest = -1;

    int i = -1, j = -1, k = -1;
    std::vector<int> dead_faces;             ///< faces on the edge, ascending
    std::vector<int> faces_of_i, faces_of_j; ///< the other faces, ascending
    std::vector<int> ring;                   ///< neighbours of i and j, ascending
    int common_neighbours = 0;
    /// Of a curve edge: the next vertices on the curve beyond i and beyond j (the lowest where curves meet there).
    int beyond_i = -1, beyond_j = -1;
    bool meets_itself = false;           ///< a curve edge, and other curve edges join i and j to one vertex
    std::vector<Face> after;             ///< corners of faces_of_i, then of faces_of_j, with k
    std::vector<FaceShape> after_shapes; ///< filled by the one who places k
    std::vector<int> sheets;             ///< of the dead faces, of faces_of_i, then of faces_of_j; at_rest: none
    int sheet_count = 0;
    std::vector<int> places;       ///< the ring vertex of each place: sheet by sheet, ascending in each
    std::vector<int> place_starts; ///< of each sheet, and their end

    bool is_curve_edge() const { return dead_faces.size() != 2; }
    int face_count() const { return static_cast<int>(dead_faces.size() + after.size()); }
    /// Of face number n of `after`.
    int sheet_of_after(std::size_t n) const { return sheets[dead_faces.size() + n]; }
    /// Id of face number n of `after`.
    int after_face(std::size_t n) const {
        return n < faces_of_i.size() ? faces_of_i[n] : faces_of_j[n - faces_of_i.size()];
    }
    /// Number of a ring vertex's place in a sheet.
    int place(int sheet, int vertex) const;
    /// Whether two faces would come to have the same corners.
    bool doubles_a_face() const;

    /// Becomes the patch of edge (i, j). Keeps its memory.
    void gather(const DynamicFaces& faces, int edge_i, int edge_j, int merged_k);

private:
    struct Neighbour {
        int vertex;
        int faces; // that hold it together with the centre
    };
    static void collect(const DynamicFaces& faces, int center, std::vector<Neighbour>& neighbours);
    static int curve_neighbour(const std::vector<Neighbour>& neighbours, int other_than);
    bool curves_meet() const;
    void find_sheets();
    void join_within_sheets(int center, const std::vector<Neighbour>& neighbours);
    void list_places();

    std::vector<Neighbour> around_i_, around_j_;
    std::vector<Face> before_; ///< corners, in the order of `sheets`
};

} // namespace plisse
