#pragma once

#include <plisse/model/model.h>

namespace plisse {

/// Estimates, in [0, 1], of how much of a run is done, for a progress display. All levels are taken to cost the same,
/// as they do within a factor of three where sheets are draped and shells pressed.
class RunFraction {
public:
    RunFraction(const Model& model, int level_count)
        : levels_(model.solve.method == Method::direct ? 1 : level_count), settles_(model.solve.settle) {}

    /// share: of the timeline, in [0, 1].
    double in_timeline(double share) const { return (settles_ ? timeline_share : 1.0) * share / levels_; }
    /// level: the one that comes into being; share: of its batches.
    double in_refinement(int level, double share) const { return (level + refinement_share * share) / levels_; }
    /// steps: settling steps done, of nobody knows how many.
    double in_settling(int level, int steps) const {
        const int index = levels_ == 1 ? 0 : level;
        const double before = index == 0 ? timeline_share : refinement_share;
        constexpr double usual_steps = 4;
        return (index + before + (1 - before) * steps / (steps + usual_steps)) / levels_;
    }

private:
    static constexpr double timeline_share = 0.7, refinement_share = 0.2;
    int levels_;
    bool settles_;
};

} // namespace plisse
