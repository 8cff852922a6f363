#pragma once

#include <span>
#include <string>
#include <vector>

#include <plisse/decimate/hierarchy.h>
#include <plisse/model/model.h>

namespace plisse {

/// An estimate, before any run, of how finely a mesh must be divided for the folds that a scene may make: for each way
/// in which a body can fold, the curvature of the folds, from closed forms. A mesh of edge h turns by about h times
/// that from face to face, and is too coarse where it would turn by more than most_turn. The constants are fitted and
/// the verdicts checked in docs/decisions/0023-how-coarse-is-sound.md. Loads may have no slack to fold with, so this is
/// an upper bound of sorts: a sound level is sound, a coarse one may do.
///
/// Symbols: D bending rigidity with bending_scale, N m; E t stretching stiffness, N/m; R radius of curvature at rest,
/// m; L size of a body (root of its area) or distance between handles, m; e strain.

/// The turn from face to face at which a mesh begins to be too coarse for its shape, rad (17 degrees). Where faces of
/// edge h have turned by theta, a finer mesh makes an arc of the crease, which bulges by h theta / 8: at this turn by
/// 4 % of the edge.
inline constexpr double most_turn = 0.3;

enum class FoldCause {
    shape,    ///< the rest shape itself
    weight,   ///< hanging folds of what is heavier than stiff
    approach, ///< handles of a flat body that come nearer to each other: one buckle
    shear,    ///< handles of a flat body that shear, twist or stretch it: wrinkles
    crush,    ///< handles or obstacles that press a curved body: ridges
    suction   ///< inward pressure that a curved body cannot bear: ridges
};
/// In words, for messages.
std::string describe(FoldCause cause);

struct FoldScale {
    FoldCause cause = FoldCause::shape;
    double radius = 0; ///< m: one over the root mean square of the curvature expected; infinite where it stays flat
    double length = 0; ///< m: the wavelength or ridge radius it comes from
};

/// (D / weight)^(1/3), m: a sheet that overhangs by more bends under its weight (N/m^2).
double bending_length(double rigidity, double weight);
/// Wavelength of wrinkles along a tension T, N/m, over a length L: 2 sqrt(pi L) (D/T)^(1/4) (Cerda and Mahadevan 2003).
/// With the tension of its own weight, that of a curtain's folds.
double wrinkle_length(double rigidity, double tension, double span);
/// Radius of the ridges between the facets of a crushed shell: R^(2/3) t^(1/3) (Lobkovsky et al. 1995), m.
double ridge_radius(double thickness, double curvature_radius);

/// One over the size of the mean curvature, averaged over the area, m: the radius of a sphere, the diameter of a tube;
/// infinite where all is flat.
double curvature_radius(const Positions& rest, std::span<const Face> faces);

/// What a shape alone asks for, as the loads below do.
FoldScale shape_scale(const Positions& rest, std::span<const Face> faces);
/// The ways in which a body may fold over the timeline, its shape among them, the smallest radius first.
std::vector<FoldScale> fold_scales(const Model& model, int body);

/// The first of these for each body.
std::vector<FoldScale> governing_scales(const Model& model);

enum class Verdict { sound, marginal, too_coarse };
const char* verdict_name(Verdict verdict);
/// On a turn expected from face to face: marginal above half of most_turn, too coarse above all of it.
Verdict verdict_on(double turn);

/// A level's edges, and the body for which they are coarsest.
struct LevelEstimate {
    double median_edge = 0, long_edge = 0; ///< m, of bodies; the median and what 95 % do not exceed
    int part = 0;
    FoldScale governing;
    double turn = 0; ///< rad, expected from face to face: that part's median edge over the governing radius
    Verdict verdict = Verdict::sound;
};
/// scales: the governing one of each part that counts, from part 0 on (obstacles, which come last, have none).
LevelEstimate estimate_level(const HierarchyLevel& level, std::span<const FoldScale> scales);

/// Vertices that a level needs lest it be too coarse, over the parts that have scales; at most all it has.
int enough_vertices(const HierarchyLevel& finest, std::span<const FoldScale> scales);

} // namespace plisse
