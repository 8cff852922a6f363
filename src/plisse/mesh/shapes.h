#pragma once

#include <plisse/mesh/generate.h>
#include <plisse/mesh/relax.h>

namespace plisse {

/// A shape ready to be a mesh (regular pattern), or to be refined and relaxed into one (irregular pattern: faces are up
/// to a few edge lengths wide, and borders and sharp edges have their final vertices).
struct Shape {
    PatchMesh mesh;
    Projection project;
};

Shape flat_sheet(const GeneratorOptions& options);
Shape box(const GeneratorOptions& options);
Shape star(const GeneratorOptions& options);
/// sphere, cylinder, dome, torus, annulus or pumpkin.
Shape revolved(const GeneratorOptions& options);
/// Regular pattern of the sphere: each face of an icosahedron with two vertices on the y axis cut into n x n.
Shape icosphere(const GeneratorOptions& options);

/// How often a length holds a step, rounded, at least `least`.
int divisions(double length, double step, int least = 1);

/// The points that cut the straight line from a to b into `count` pieces, without its ends, as fixed vertices.
std::vector<int> add_straight_points(PatchMesh& mesh, Vec3 a, Vec3 b, int count);

/// Height of an equilateral triangle of edge 1.
inline constexpr double row_height = 0.86602540378443864676;

} // namespace plisse
