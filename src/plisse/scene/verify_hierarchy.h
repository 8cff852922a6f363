#pragma once

#include <plisse/decimate/hierarchy.h>

namespace plisse {

/// How well a level and the map between it and the finest hold what prolongation and contact rely on (DESIGN.md
/// section 5).
struct LevelVerification {
    int level = 0;
    double rest_error = 0;     ///< largest |P(rest) - rest| over the diagonal of the finest level
    double rigid_error = 0;    ///< largest |P(Q x + c) - (Q P(x) + c)| over the diagonal, over seeded rotations
    double worst_weight = 0;   ///< smallest barycentric weight, 0 when all are as they should be
    double worst_sum = 0;      ///< largest |1 - sum of weights|
    int missing_anchors = 0;   ///< vertices some face uses that have no anchor
    int coincident_images = 0; ///< finest vertices whose image another one has too
    int mapped_faces = 0;      ///< finest faces whose corners all lie in one face of the level ...
    int folded_faces = 0; ///< ... and those of them that are turned over there: 0 for a bijective map of fine faces

    int missing_ways_back = 0; ///< vertices of the level that have no anchor on the finest
    /// There and back: how far a vertex of the level is from the image of its place on the finest level, over the
    /// diagonal. The image is taken as straight within a fine face, so on curved surfaces it is off by what a fine face
    /// bulges.
    double mean_return_error = 0, largest_return_error = 0;
    /// Hausdorff's distance of the two surfaces, measured from the vertices of both, over the diagonal.
    double distance = 0;
    int new_intersections = 0; ///< intersecting pairs of faces beyond those of the finest level

    /// Round-off apart, everything is as it should be. Folded faces do not count: between its corners the image of a
    /// fine face is bent, so a bijective map may turn the straight triangle of a sliver over.
    bool holds() const;
};

/// One for each level but the finest.
std::vector<LevelVerification> verify_hierarchy(const Hierarchy& hierarchy);

} // namespace plisse
