#pragma once

#include <algorithm>

namespace plisse {

/// Which positive semi-definite matrix stands for a pair's Hessian (see pair_energy.h).
enum class HessianKind { projected, gauss_newton };

struct ContactOptions {
    double distance = 1e-3; ///< m, > 0: surfaces whose gap is less than this repel
    double stiffness = 1e6; ///< Pa, > 0: scale of the barrier's pressure
    bool self = true;       ///< whether a body meets itself (different bodies always meet)
    double ccd_ratio = 0.1; ///< in (0, 1): share of its gap a pair keeps in one step at least
    HessianKind hessian = HessianKind::projected;
    double thickness = 0; ///< m, >= 0: surfaces stay apart by more than this
    double enforced = 1;  ///< in [0, 1]: share of the thickness that no pair may come below. Less than 1 lets surfaces
                          ///< that are too near push each other to where they belong.

    /// The largest activation distance of any pair, m.
    double reach() const { return thickness + distance; }
    /// Of the distance of a pair that stays further apart than `least`, what it keeps during a step, m.
    double kept_distance(double pair_distance, double least) const {
        return least + std::min(ccd_ratio * (pair_distance - least), distance);
    }
};

/// Distances of one pair of primitives, m.
struct PairRange {
    double thickness = 0;  ///< its gap is what its distance has beyond this
    double least = 0;      ///< in [0, thickness]: it stays further apart than this
    double activation = 0; ///< > least: it repels when nearer than this
};

/// The range of a pair that is `rest_distance` apart at rest. A body at rest feels nothing: within one part the
/// thickness is at most half of the distance at rest, and every pair repels at most halfway from its thickness to that
/// distance. Thick bodies that start hardly further apart than their thickness, or nearer, have no silent rest to
/// protect, nor have pairs that touch at rest.
inline PairRange pair_range(const ContactOptions& options, bool same_part, double rest_distance) {
    constexpr double least_share = 0.1; // of the contact distance, over which different thick bodies repel
    PairRange range;
    range.thickness =
        same_part && rest_distance > 0 ? std::min(options.thickness, 0.5 * rest_distance) : options.thickness;
    const double halfway = 0.5 * (rest_distance - range.thickness);
    const double shortest = options.thickness > 0 && !same_part ? least_share * options.distance : 0;
    const double gap = halfway > 0 ? std::min(options.distance, std::max(halfway, shortest)) : options.distance;
    range.least = options.enforced * range.thickness;
    range.activation = range.thickness + gap;
    return range;
}

} // namespace plisse
