#pragma once

#include <functional>
#include <limits>
#include <string>

#include <plisse/base/context.h>
#include <plisse/solve/trust_region_iterate.h>

namespace plisse {

/// Why a trust-region method ended.
enum class TrustRegionEnd {
    gradient,      ///< converged: |g| is below its tolerance
    small_change,  ///< converged: the value or x changed by less than small_change within a radius above free_radius
    rounding,      ///< converged: full steps promise less than the noise in the value, several times in a row
    stalled,       ///< rejected until the steps are too short to change x
    iteration_cap, ///< max_iterations were done
    interrupted,   ///< cancelled
    infeasible,    ///< the value is infinite where it starts
};
bool is_converged(TrustRegionEnd end);
const char* in_words(TrustRegionEnd end);

/// When to end: criterion (7.1) of Kopanicakova, Krause and Tamstorf (2019), of accepted steps, and one more: where the
/// radius bounds nothing and the model promises less than the noise in the value, nothing is left to gain.
struct TrustRegionStop {
    double gradient = 1e-7;      ///< Euclidean norm
    double small_change = 1e-12; ///< of the value, or the Euclidean norm of the step
    double free_radius = 1e15;
    int noisy_steps = 3; ///< in a row for `rounding`; 0 turns it off
    int max_iterations = 1000;
};

/// A rejected step tells how far down the next may go. rmtr does better with the paper's halves (decision 0025).
inline TrustRegionConstants interpolating_constants() {
    TrustRegionConstants constants;
    constants.least_gamma = 1.0 / 16;
    return constants;
}

struct TrustRegionOptions {
    TrustRegionConstants constants = interpolating_constants();
    TrustRegionStop stop;
    QuadraticOptions quadratic;
    double radius = 1; ///< the first
};

struct TrustRegionIteration {
    int iteration = 0;
    double value = 0;         ///< after it
    double gradient_norm = 0; ///< after it
    TrialStep trial;
};

struct TrustRegionSummary {
    TrustRegionEnd end = TrustRegionEnd::gradient;
    std::string message; ///< why it ended, in words
    double value = 0, gradient_norm = 0;
    double radius = 0; ///< the last
    int iterations = 0, accepted = 0;
    int evaluations = 0, assemblies = 0, quadratic_solves = 0;
    double quadratic_products = 0; ///< see QuadraticStep
    bool converged() const { return is_converged(end); }
};

/// Decides on (7.1) and on rounding, step by step.
class StopTest {
public:
    explicit StopTest(const TrustRegionStop& stop) : stop_(stop) {}
    /// Whether an accepted change within a radius ends the run; why is in `end`.
    bool changed(double value, double length, double radius, bool in_noise, TrustRegionEnd& end);

private:
    const TrustRegionStop& stop_;
    int noisy_ = 0;
};

/// Trust-region method from x (algorithm 4.1), which ends at the last accepted point. Radii have no cap; H is assembled
/// after accepted steps only. prolongations: for a multigrid preconditioner, the coarsest first.
TrustRegionSummary minimize_by_trust_region(Objective& objective, VecX& x, const TrustRegionOptions& options,
                                            Context& context,
                                            const std::function<void(const TrustRegionIteration&)>& observe = {},
                                            std::span<const ScalarTransfer* const> prolongations = {});

} // namespace plisse
