#pragma once

#include <vector>

#include "surface_contest.h"

namespace plisse {

/// What `plisse bench rmtr` has measured so far.
struct RmtrResults {
    std::vector<SurfaceRun> runs;
    struct ConditionOf {
        bool boundary_variables = false;
        double penalty = 0; ///< N/m^3; 0: h^-5
        Condition condition;
    };
    std::vector<ConditionOf> conditions;
    std::vector<LargestStep> largest_steps;

    /// Null where it has not run.
    const SurfaceRun* find(Scenario scenario, Way way, int levels) const;
    /// Whether anyone has run in it.
    bool has(Scenario scenario) const;
    /// The most levels that anyone ran with.
    int most_levels() const;
};

/// Ratios of the trust region to rmtr where both converged, by scenario and unknowns.
nlohmann::ordered_json rmtr_ratios(const RmtrResults& results);
nlohmann::ordered_json rmtr_results_json(const RmtrResults& results);

} // namespace plisse
