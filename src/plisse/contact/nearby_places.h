#pragma once

#include <span>
#include <vector>

#include <plisse/contact/collision_mesh.h>
#include <plisse/contact/contact_options.h>
#include <plisse/geometry/distance.h>

namespace plisse {

/// A triangle that a point is nearer to than their activation distance.
struct NearTriangle {
    int face;
    std::array<int, 4> vertices; ///< the point and the face's corners
    PairRange range;
    Separation separation;
};

/// A place of the surface that a point repels: a face, an edge or a vertex, counted `count` times.
struct NearPlace {
    int face;                    ///< a face that it belongs to
    std::array<int, 4> vertices; ///< the point and that face's corners
    PairRange range;
    Separation separation;
    int count;                  ///< not 0; below 0 where faces that meet in an edge both count
    std::array<int, 3> corners; ///< the place's own vertices, descending; -1 where there are fewer
};

/// Lists what a point repels such that each place of the surface counts once, however it is triangulated, by inclusion
/// and exclusion: each face at its closest point, less each edge between two faces (k - 1 times
/// where k faces meet), plus each vertex within a fan of faces. Above a flat patch all but the face below cancels;
/// across a ridge or a peak one edge or vertex is left. (After the convergent incremental potential of Li et al. 2023.)
///
/// near: all triangles that the point is near to, ascending; they do not have the point as a corner. An edge and a
/// vertex repel within the least range of their faces. `places` is cleared first.
void find_nearby_places(const CollisionMesh& mesh, const Positions& x, std::span<const NearTriangle> near,
                        std::vector<NearPlace>& places);

} // namespace plisse
