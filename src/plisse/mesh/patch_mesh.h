#pragma once

#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// A triangle mesh under construction. Each face belongs to a patch, a smooth piece of the surface; edges between
/// patches are the sharp edges and never flip. Vertices are fixed (on borders and sharp edges) or move within their
/// patch.
///
/// Corner 3 f + k stands for corner k of face f and for the half-edge from it to the next corner. Stored:
///   twins          the half-edge that runs the other way along the same edge, -1 on a border
///   vertex_corner  some corner at each vertex
class PatchMesh {
public:
    static constexpr int fixed = -1;

    /// patch: of a vertex that moves, or `fixed`. Returns the vertex number.
    int add_vertex(const Vec3& point, int patch);
    void add_face(const Face& face, int patch);
    /// Fills the strip between two chains of vertices, from (lower[0], upper[0]) to their last vertices, by the shorter
    /// diagonal first. A chain may be one vertex. Seen from the front, upper is to the left of lower.
    void zip(std::span<const int> lower, std::span<const int> upper, int patch);
    /// Finds the twins. Call once, when all faces of a manifold are there; flip and insert keep them.
    void connect();

    int vertex_count() const { return static_cast<int>(points.size()); }
    int face_count() const { return static_cast<int>(faces.size()); }
    int vertex(int corner) const { return faces[face_of(corner)][static_cast<std::size_t>(corner % 3)]; }
    int twin(int corner) const { return twins_[static_cast<std::size_t>(corner)]; }
    static int next(int corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static int previous(int corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
    static std::size_t face_of(int corner) { return static_cast<std::size_t>(corner / 3); }
    const Vec3& point(int vertex) const { return points[static_cast<std::size_t>(vertex)]; }

    /// Whether the half-edge lies inside a patch and its other diagonal joins two vertices that are not joined yet.
    bool can_flip(int corner) const;
    /// Turns the edge to the other diagonal of its two faces, whose corners are 0: the half-edge's start, then onward.
    void flip(int corner);
    /// Puts a new vertex into a face, which is replaced by three; returns the vertex. The two new faces come last.
    int insert(int face, const Vec3& point);

    /// Calls visit(corner) for each corner at a vertex that lies inside the surface.
    template <typename Visit>
    void around(int vertex, const Visit& visit) const {
        const int first = vertex_corner_[static_cast<std::size_t>(vertex)];
        int corner = first;
        do {
            visit(corner);
            corner = twin(previous(corner));
        } while (corner != first);
    }

    std::vector<Vec3> points;
    std::vector<int> vertex_patch;
    std::vector<Face> faces;
    std::vector<int> face_patch;

private:
    bool joined(int a, int b) const;
    void link(int corner, int twin);
    void place(int face, const Face& vertices);

    std::vector<int> twins_;
    std::vector<int> vertex_corner_;
};

} // namespace plisse
