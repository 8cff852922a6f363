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
    std::vector<RmtrLevelWork> work; ///< per level, of rmtr
    double assembly_units = 0, quadratic_units = 0;
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

    /// Sets loads and handles as in the step; solve() does so itself.
    void begin_step(const SurfaceStep& step);

private:
    SurfaceOutcome by_rmtr(VecX& x, const std::function<void(const SurfaceIteration&)>& observe);
    SurfaceOutcome by_trust_region(VecX& x, const std::function<void(const SurfaceIteration&)>& observe);
    SurfaceOutcome by_line_search(VecX& x, const std::function<void(const SurfaceIteration&)>& observe);
    /// Newton's steps times a factor, at most so many.
    SurfaceOutcome by_fixed_steps(VecX& x, double factor, int most,
                                  const std::function<void(const SurfaceIteration&)>& observe);

    const SubdivisionModel& model_;
    const RmtrSettings& settings_;
    Context& context_;
    std::unique_ptr<SurfaceContact> contact_; ///< null where nothing may touch
    std::vector<std::unique_ptr<SubdivisionProblem>> problems_;
    std::vector<std::unique_ptr<LevelTransfer>> transfers_; ///< number l is between l and l + 1
};

} // namespace plisse
