#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <plisse/base/context.h>
#include <plisse/model/subdivision_problem.h>
#include <plisse/solve/rmtr.h>

namespace plisse {

/// An iteration of a step, or a cycle.
struct SurfaceIteration {
    int iteration = 0, level = 0;
    double value = 0, gradient_norm = 0, radius = 0;
};

/// How a step ended.
struct SurfaceOutcome {
    TrustRegionEnd end = TrustRegionEnd::gradient;
    std::string message; ///< in words
    int iterations = 0;  ///< or cycles, on the finest level
    double gradient_norm = 0;
    std::vector<RmtrLevelWork> work; ///< per level of rmtr, the coarsest first; one for solvers of the finest alone

    /// Adds what a later part of the step did, and ends as it did.
    void go_on(const SurfaceOutcome& part);
};

/// Minimises steps of the method rmtr with the solver its settings name, on all levels of a model.
class SurfaceStepper {
public:
    /// The model must outlive the stepper.
    SurfaceStepper(const SubdivisionModel& model, Context& context);

    /// From x, the finest level's variables, to where the step leads.
    SurfaceOutcome solve(const SurfaceStep& step, VecX& x,
                         const std::function<void(const SurfaceIteration&)>& observe = {});

    SubdivisionProblem& finest() { return *problems_.back(); }
    /// The finest limit points at x, m.
    Positions limit_points(const VecX& x) const;
    /// Where the obstacles are now, m.
    Positions obstacles() const;
    /// Of the last step; empty where nothing can rub.
    FrictionMemory friction_memory() const;

    /// Puts obstacles where scripts have them at t, whatever is in the way: where a run begins or goes on.
    void place_obstacles(double t);
    /// Sets loads and handles as in the step; solve() does so itself.
    void begin_step(const SurfaceStep& step);

private:
    using Observer = std::function<void(const SurfaceIteration&)>;

    /// From x to the minimum with everything else where it is. thorough: begins on the coarsest level, where asked for.
    SurfaceOutcome minimize(VecX& x, int most_cycles, bool thorough, const Observer& observe);
    /// The same, obstacles having moved to where they are at t before, cloth giving way.
    SurfaceOutcome minimize_with_obstacles(double t, VecX& x, const Observer& observe);
    /// Goes on until normal forces of friction no longer change.
    void bring_friction_to_rest(VecX& x, SurfaceOutcome& outcome, const Observer& observe);
    SurfaceOutcome by_rmtr(VecX& x, int most_cycles, bool nested, const Observer& observe);
    SurfaceOutcome by_trust_region(VecX& x, int most, const Observer& observe);
    SurfaceOutcome by_line_search(VecX& x, int most, const Observer& observe);
    /// Newton's steps times a factor, no longer than is safe, at most so many.
    SurfaceOutcome by_fixed_steps(VecX& x, double factor, int most, const Observer& observe);

    const SubdivisionModel& model_;
    const RmtrSettings& settings_;
    Context& context_;
    std::unique_ptr<SurfaceContact> contact_; ///< null where nothing may touch
    VertexWeights limit_weights_;             ///< of the finest limit points
    std::vector<std::unique_ptr<SubdivisionProblem>> problems_;
    std::vector<std::unique_ptr<LevelTransfer>> transfers_; ///< number l is between l and l + 1
};

} // namespace plisse
