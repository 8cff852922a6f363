#pragma once

#include <cstdint>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

enum class GeneratorShape { sheet, box, sphere, cylinder, dome, torus, annulus, pumpkin, star };
enum class Pattern { irregular, regular, quad };
enum class Diagonals { alternating, one };

/// The generators of scene files: every shape centred at the origin, metres, +y up. Only the fields of the shape at
/// hand are read.
struct GeneratorOptions {
    GeneratorShape shape = GeneratorShape::sheet;
    Vec3 size{1, 1, 1};    ///< sheet: x and z (first two entries); box: x, y, z
    double radius = 0.5;   ///< sphere, cylinder, dome, torus (of the ring), pumpkin (at its ribs), star (at its tips)
    double height = 1;     ///< cylinder, pumpkin, star
    bool caps = false;     ///< cylinder
    double angle_deg = 90; ///< dome: from apex to rim, up to 175
    double tube = 0.2;     ///< torus
    double inner = 0.25, outer = 0.5; ///< annulus
    int lobes = 8;                    ///< pumpkin
    int points = 5;                   ///< star
    double depth = 0.2;               ///< star: how far the notches go in, as a share of radius
    double twist_deg = 0;             ///< star: top against bottom, straight lines between; within -180 and 180
    double edge_length = 0.05;        ///< > 0
    Pattern pattern = Pattern::irregular;
    Diagonals diagonals = Diagonals::alternating; ///< regular sheets
    std::array<int, 2> cells{0, 0};               ///< sheets: nx, nz, not irregular; 0 takes them from edge_length
    std::uint64_t seed = 1;
};

/// The same options give the same mesh, to the bit, on every machine. Irregular patterns are Delaunay-type meshes of
/// relaxed points, their mean edge edge_length; regular ones do not depend on the seed. Vertices lie on the exact
/// surface; borders and sharp edges are cut evenly, with vertices where a circle crosses the x and z axes, so the
/// bounding box is exact (of a regular sphere in y only). Closed shapes face outward, flat ones +y. An edge_length too
/// large for the shape gives its coarsest mesh. Throws InputError (with an empty place) for options that make no mesh,
/// or one of more than 5 million vertices, and for a star so thin or twisted that its walls would meet.
TriangleMesh generate_mesh(const GeneratorOptions& options);

} // namespace plisse
