#pragma once

#include <functional>

#include <plisse/base/random.h>
#include <plisse/mesh/patch_mesh.h>

namespace plisse {

/// The point of a patch's exact surface that a nearby point belongs to.
using Projection = std::function<Vec3(int patch, const Vec3& point)>;

/// Flips edges inside patches until every pair of faces is Delaunay (opposite angles add to at most pi; Lawson 1977).
/// No flip folds the surface.
void make_delaunay(PatchMesh& mesh);

/// Puts vertices into the largest faces until the mean area of a face is at most face_area, keeping the mesh Delaunay.
void refine(PatchMesh& mesh, double face_area, const Projection& project, Random& random);

/// Moves each free vertex to the area-weighted centroid of its faces' centroids (Chen and Holst 2011, "CPT") and flips
/// to Delaunay, `rounds` times. No move folds the surface.
void relax(PatchMesh& mesh, int rounds, const Projection& project);

} // namespace plisse
