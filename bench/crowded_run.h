#pragma once

#include <vector>

#include <plisse/base/timing.h>
#include <plisse/contact/contact.h>

namespace plisse {

/// One call of the step filter, and the places at which the energy was evaluated after it.
struct StepQuery {
    Positions x, d; ///< how far can x go along d?
    std::vector<Positions> trials;
};

/// What Newton's method asks of contact where a twisted cloth lies in folds upon itself.
struct CrowdedRun {
    CollisionMesh mesh;
    ContactOptions options;
    std::vector<StepQuery> queries;
    int iterations = 0, projected_hessians = 0, exact_hessians = 0;
    double seconds = 0; ///< CPU time of one iteration
    PhaseTimes phases;  ///< wall time of all
    double per_iteration(double calls) const { return calls / iterations; }
};

/// The last quarter of a run of `plisse bench twist` on one mesh of about 1400 vertices, on one thread.
const CrowdedRun& crowded_run();

} // namespace plisse
