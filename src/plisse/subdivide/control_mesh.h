#pragma once

#include <plisse/mesh/quad_connectivity.h>

namespace plisse {

/// A side of a domain face that bounds the domain: from corner `side` to corner side + 1 (mod 4) of the face.
struct BoundarySide {
    int face, side;
};

/// The control mesh of a Catmull-Clark surface that ends at its domain: the faces that carry surface, and one ring of
/// ghost faces around every boundary, so that no rule for boundaries is ever used (RMTR section 5.2.1). Every domain
/// vertex is surrounded by faces; those on the boundary by four.
struct ControlMesh {
    int vertex_count = 0;
    int domain_vertex_count = 0; ///< those of domain faces, which come first
    int domain_face_count = 0;   ///< which come first
    std::vector<Quad> faces;
    std::vector<BoundarySide> boundary;

    int ghost_count() const { return vertex_count - domain_vertex_count; }
    bool is_ghost(int vertex) const { return vertex >= domain_vertex_count; }
    QuadConnectivity connectivity() const { return QuadConnectivity(vertex_count, faces); }
};

/// Where a ghost vertex is.
struct Ghost {
    enum class Kind {
        edge,      ///< across the boundary from `vertex`, by an edge
        corner,    ///< across a convex corner `vertex`, by the diagonal of the ghost face there
        reentrant, ///< the same at a re-entrant corner: both boundary neighbours of `vertex` reach it by an edge
    };
    Kind kind;
    int vertex;
};

/// Of every ghost vertex, in order.
std::vector<Ghost> find_ghosts(const ControlMesh& mesh);

struct ControlCage {
    ControlMesh mesh;
    Positions positions; ///< of its vertices
};

/// The control mesh whose domain is `quads`, in its order. On the boundary 2, 3 or 4 edges (1, 2 or 3 faces) make a
/// convex corner, a straight piece and a re-entrant corner. Ghost positions continue the mesh, p_-1 = 2 p_0 - p_1, at
/// convex corners along both sides, so an even flat grid stays one. At a re-entrant corner p between a and b the ghost
/// is a + b - p (the mean where corners share it): so a notch one face wide keeps the lines of its grid even where
/// these are not evenly spaced. Throws InputError (with an empty place) for more faces at a boundary vertex, for three
/// that make no re-entrant corner (225 degrees or more), and for slots and holes one face wide.
ControlCage with_ghost_ring(const QuadMesh& quads);

} // namespace plisse
