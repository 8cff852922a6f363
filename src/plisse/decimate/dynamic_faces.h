#pragma once

#include <span>
#include <vector>

#include <plisse/decimate/hierarchy.h>

namespace plisse {

/// The faces of a hierarchy in hierarchy ids, while collapses are made or undone. A vertex is present when a face uses
/// it. Whatever legal order the collapses of a level are undone in, the faces end up the same, corner by corner.
class DynamicFaces {
public:
    /// faces: face f has id f; vertex_id_count: bound of all ids that will ever appear.
    DynamicFaces(std::span<const Face> faces, int vertex_id_count);
    /// The faces of one level.
    DynamicFaces(const Hierarchy& hierarchy, int level);

    int vertex_id_count() const { return static_cast<int>(vertex_faces_.size()); }
    int face_id_count() const { return static_cast<int>(faces_.size()); }
    bool has_vertex(int vertex) const { return !vertex_faces_[vertex].empty(); }
    bool has_face(int face) const { return faces_[face][0] >= 0; }

    /// Corners of a face that is present.
    const Face& face(int face) const { return faces_[face]; }
    /// Ids of the faces around a vertex, ascending.
    const std::vector<int>& vertex_faces(int vertex) const { return vertex_faces_[vertex]; }
    /// Neighbours of a vertex, ascending; `ring` is cleared first.
    void ring(int vertex, std::vector<int>& ring) const;
    /// How many faces use the edge.
    int edge_face_count(int a, int b) const;
    /// Whether the edge bounds sheets: one face uses it, or more than two.
    bool is_curve_edge(int a, int b) const { return edge_face_count(a, b) != 2; }

    /// Makes a collapse: i and j leave, k comes, the dead faces leave.
    void collapse(const Collapse& collapse);
    /// Undoes a collapse exactly. It must be legal.
    void expand(const Collapse& collapse);
    /// Whether a collapse can be undone now: k and its whole ring are present. As ids are never reused this suffices.
    bool is_legal(const Collapse& collapse) const;

private:
    void add_face(int face, const Face& corners);
    void remove_face(int face);
    void replace_corner(std::span<const int> faces, int from, int to);

    std::vector<Face> faces_;                    // by id; -1 in every corner when absent
    std::vector<std::vector<int>> vertex_faces_; // by id, ascending
};

} // namespace plisse
