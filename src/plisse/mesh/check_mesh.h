#pragma once

#include <array>
#include <string>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// What a mesh is like, and everything that would stop a run. Lists are complete, ascending.
struct MeshCheck {
    int vertices = 0, faces = 0, components = 0, unreferenced_vertices = 0;
    int boundary_loops = 0;                 ///< connected pieces of the graph of edges that have one face
    int euler_characteristic = 0;           ///< of the part that faces use
    int sheets = 0;                         ///< pieces that hang together across edges of two faces
    std::vector<Edge> non_manifold_edges;   ///< more than two faces: sheets are joined there, which a run allows
    std::vector<Edge> inconsistent_edges;   ///< two faces, no more, that run along the edge in the same direction
    std::vector<int> non_manifold_vertices; ///< faces around the vertex hang together in it alone
    std::vector<int> degenerate_faces;      ///< zero area (to round-off) or a repeated vertex
    std::vector<int> duplicate_faces;       ///< same three vertices as an earlier face
    std::vector<std::array<int, 2>> intersecting_faces;

    /// Nothing found that would stop a run.
    bool usable() const;
};

/// Looks at everything; intersections by exact predicates (degenerate faces take no part in those).
MeshCheck check_mesh(const TriangleMesh& mesh);

/// Sentences, one a finding that would stop a run: the count and the first few places with their coordinates.
std::vector<std::string> describe_findings(const MeshCheck& check, const TriangleMesh& mesh);

} // namespace plisse
