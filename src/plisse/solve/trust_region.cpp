#include <plisse/solve/trust_region.h>

#include <cmath>

#include <fmt/format.h>

namespace plisse {

bool is_converged(TrustRegionEnd end) {
    return end == TrustRegionEnd::gradient || end == TrustRegionEnd::small_change || end == TrustRegionEnd::rounding;
}

const char* in_words(TrustRegionEnd end) {
    switch (end) {
    case TrustRegionEnd::gradient:
        return "converged: the gradient vanishes";
    case TrustRegionEnd::small_change:
        return "converged: free steps change nothing any more";
    case TrustRegionEnd::rounding:
        return "converged: what is left to gain is below rounding";
    case TrustRegionEnd::stalled:
        return "stalled: no step is accepted, however short";
    case TrustRegionEnd::iteration_cap:
        return "cut short at the iteration cap";
    case TrustRegionEnd::interrupted:
        return "interrupted";
    case TrustRegionEnd::infeasible:
        return "the start is infeasible";
    }
    return "";
}

bool StopTest::changed(double value, double length, double radius, bool in_noise, TrustRegionEnd& end) {
    if (radius > stop_.free_radius && (std::abs(value) < stop_.small_change || length < stop_.small_change)) {
        end = TrustRegionEnd::small_change;
        return true;
    }
    noisy_ = in_noise ? noisy_ + 1 : 0;
    if (stop_.noisy_steps > 0 && noisy_ >= stop_.noisy_steps) {
        end = TrustRegionEnd::rounding;
        return true;
    }
    return false;
}

namespace {

/// One run: the state that its iterations share.
class TrustRegion {
public:
    TrustRegion(Objective& objective, const TrustRegionOptions& options, Context& context,
                std::span<const ScalarTransfer* const> prolongations)
        : options_(options), context_(context), solver_(make_quadratic_solver(options.quadratic, prolongations)),
          iterate_(objective, *solver_, options.constants), stop_(options.stop) {}

    TrustRegionSummary run(VecX& x, const std::function<void(const TrustRegionIteration&)>& observe) {
        summary_.radius = options_.radius;
        iterate_.start(x);
        if (!std::isfinite(iterate_.value()))
            return ended(TrustRegionEnd::infeasible);
        for (;;) {
            if (iterate_.gradient_norm() < options_.stop.gradient)
                return ended(TrustRegionEnd::gradient);
            if (context_.cancelled())
                return ended(TrustRegionEnd::interrupted);
            if (summary_.iterations >= options_.stop.max_iterations)
                return ended(TrustRegionEnd::iteration_cap);
            const TrialStep trial = iterate_.step(summary_.radius);
            ++summary_.iterations;
            summary_.radius = next_radius(options_.constants, summary_.radius, trial);
            if (trial.accepted) {
                ++summary_.accepted;
                x = iterate_.x();
                iterate_.objective().on_accepted(x);
            }
            if (observe)
                observe({summary_.iterations, iterate_.value(), iterate_.gradient_norm(), trial});
            TrustRegionEnd end{};
            if (trial.accepted && !trial.cut &&
                stop_.changed(trial.actual, trial.length, trial.radius, trial.in_noise && !trial.on_boundary, end))
                return ended(end);
            if (!trial.accepted && !trial.cut &&
                (trial.length <= shortest * x.norm() || summary_.radius < least_radius))
                return ended(TrustRegionEnd::stalled);
        }
    }

private:
    static constexpr double shortest = 1e-16;      ///< step, as a share of |x|: rounding swallows it
    static constexpr double least_radius = 1e-150; ///< its square is still a number

    TrustRegionSummary ended(TrustRegionEnd end) {
        summary_.end = end;
        summary_.value = iterate_.value();
        summary_.gradient_norm = iterate_.gradient_norm();
        summary_.evaluations = iterate_.evaluations();
        summary_.assemblies = iterate_.assemblies();
        summary_.quadratic_solves = iterate_.quadratic_solves();
        summary_.quadratic_products = iterate_.quadratic_products();
        summary_.message = fmt::format("{} after {} iterations, with |g| = {:.3g} and radius {:.3g}", in_words(end),
                                       summary_.iterations, summary_.gradient_norm, summary_.radius);
        return summary_;
    }

    const TrustRegionOptions& options_;
    Context& context_;
    std::unique_ptr<QuadraticSolver> solver_;
    TrustRegionIterate iterate_;
    StopTest stop_;
    TrustRegionSummary summary_;
};

} // namespace

TrustRegionSummary minimize_by_trust_region(Objective& objective, VecX& x, const TrustRegionOptions& options,
                                            Context& context,
                                            const std::function<void(const TrustRegionIteration&)>& observe,
                                            std::span<const ScalarTransfer* const> prolongations) {
    return TrustRegion(objective, options, context, prolongations).run(x, observe);
}

} // namespace plisse
