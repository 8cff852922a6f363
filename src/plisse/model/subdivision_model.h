#pragma once

#include <array>
#include <string>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>
#include <plisse/model/model.h>
#include <plisse/model/track.h>
#include <plisse/subdivide/subdivision_levels.h>

namespace plisse {

/// What holds pieces of a cloth's boundary, or points of it, where a script has them.
struct BoundaryHandle {
    std::string name;
    std::vector<int> sides;  ///< held along their length: numbers of the finest level's boundary sides, ascending
    std::vector<int> points; ///< held alone: domain vertices of the finest level, ascending
    std::array<bool, 3> axes{true, true, true};
    MotionTrack motion;
};

/// Everything a run by the method rmtr needs: one cloth as a Catmull-Clark surface on nested levels.
struct SubdivisionModel {
    explicit SubdivisionModel(SubdivisionLevels of_rest) : levels(std::move(of_rest)) {}

    std::string name, body;
    SubdivisionLevels levels; ///< of the rest shape
    TriangleMesh surface;     ///< the finest level's limit points at rest, two triangles for every domain face
    Material material;
    /// Directions of the warp at rest, one for all faces or one for each of level 0; on each face, its tangent part.
    std::vector<Vec3> warp{Vec3::UnitX()};
    std::vector<BoundaryHandle> handles;
    TriangleMesh obstacles;              ///< all of them in one mesh, m, before their motion
    std::vector<int> obstacle_of_vertex; ///< number of the obstacle that each vertex belongs to, ascending
    std::vector<std::string> obstacle_names;
    std::vector<MotionTrack> obstacle_motions;
    ContactSettings contact;
    Track<Vec3> gravity{Vec3(0, -9.81, 0)}; ///< m/s^2
    SolveSettings solve;

    /// The same on a level, whose faces take after those that they are parts of.
    std::vector<Vec3> warp_on(int level) const;
    /// Where scripts have the obstacles, m.
    Positions obstacles_at(double t) const;
};

/// The limit points of a level at rest, two triangles for every domain face.
TriangleMesh limit_surface(const SubdivisionLevels& levels, int level);

} // namespace plisse
