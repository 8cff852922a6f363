#include <plisse/solve/rmtr.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>

#include <fmt/format.h>

namespace plisse {

RmtrLevelWork& RmtrLevelWork::operator+=(const RmtrLevelWork& other) {
    visits += other.visits;
    accepted += other.accepted;
    rejected += other.rejected;
    corrections_accepted += other.corrections_accepted;
    corrections_rejected += other.corrections_rejected;
    assemblies += other.assemblies;
    quadratic_solves += other.quadratic_solves;
    quadratic_iterations += other.quadratic_iterations;
    evaluations += other.evaluations;
    quadratic_products += other.quadratic_products;
    largest_correction = std::max(largest_correction, other.largest_correction);
    return *this;
}

namespace {

template <typename Number>
double work_units(std::span<const RmtrLevelWork> levels, Number RmtrLevelWork::*count) {
    double units = 0;
    for (const RmtrLevelWork& level : levels)
        units = units / 4 + level.*count;
    return units;
}

} // namespace

double assembly_units(std::span<const RmtrLevelWork> levels) {
    return work_units(levels, &RmtrLevelWork::assemblies);
}

double quadratic_units(std::span<const RmtrLevelWork> levels) {
    return work_units(levels, &RmtrLevelWork::quadratic_solves);
}

double product_units(std::span<const RmtrLevelWork> levels) {
    constexpr double products_of_unit = 10;
    return work_units(levels, &RmtrLevelWork::quadratic_products) / products_of_unit;
}

namespace {

/// The method on a hierarchy. Levels count from the coarsest, 0, to finest().
class Rmtr {
public:
    Rmtr(std::span<Objective* const> levels, std::span<const LevelTransfer* const> transfers,
         const RmtrOptions& options, Context& context)
        : transfers_(transfers), options_(options), context_(context), work_(levels.size()),
          remembered_(levels.size(),
                      {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}),
          norm_bound_(levels.size(), 1.0), resting_(levels.size(), 0), streak_(levels.size(), 0) {
        for (const LevelTransfer* transfer : transfers)
            prolongations_.push_back(&transfer->prolongation());
        for (std::size_t l = 0; l < levels.size(); ++l) {
            solvers_.push_back(make_quadratic_solver(quadratic_options(l), std::span(prolongations_).first(l)));
            iterates_.push_back(std::make_unique<TrustRegionIterate>(*levels[l], *solvers_.back(), options.constants));
        }
        for (std::size_t l = finest(); l-- > 0;)
            norm_bound_[l] = norm_bound_[l + 1] * norm_bound(*prolongations_[l]);
    }

    /// Cycles until a test ends them. `total` gains the work.
    RmtrSummary run(VecX& x, const std::function<void(const RmtrCycle&)>& observe) {
        TrustRegionIterate& top = *iterates_[finest()];
        StopTest stop(options_.stop);
        Radii radii{options_.radius, options_.radius};
        RmtrSummary summary;
        summary.levels.resize(iterates_.size());
        const auto ended = [&](TrustRegionEnd end) {
            summary.end = end;
            summary.value = top.value();
            summary.gradient_norm = top.gradient_norm();
            summary.radius = radii.smoothing;
            summary.message = fmt::format("{} after {} cycles, with |g| = {:.3g} and radius {:.3g}", in_words(end),
                                          summary.cycles, summary.gradient_norm, radii.smoothing);
            return summary;
        };
        top.start(x);
        if (!std::isfinite(top.value()))
            return ended(TrustRegionEnd::infeasible);
        for (;;) {
            if (top.gradient_norm() < options_.stop.gradient)
                return ended(TrustRegionEnd::gradient);
            if (context_.cancelled())
                return ended(TrustRegionEnd::interrupted);
            if (summary.cycles >= options_.stop.max_iterations)
                return ended(TrustRegionEnd::iteration_cap);
            const double value = top.value(), radius_before = radii.smoothing;
            moved_ = hampered_ = cut_ = false;
            radii = visit(finest(), radii, std::numeric_limits<double>::infinity());
            ++summary.cycles;
            const double length = (top.x() - x).norm(), change = value - top.value();
            x = top.x();
            report(summary, radii.smoothing, observe);
            TrustRegionEnd end{};
            const bool in_noise = std::abs(change) < top.noise(value) && !hampered_;
            if (moved_ && !cut_ && stop.changed(change, length, radius_before, in_noise, end))
                return ended(end);
            if (!moved_ && radii.smoothing < least_radius * std::max(1.0, x.norm()))
                return ended(TrustRegionEnd::stalled);
        }
    }

private:
    /// What bounds a level's smoothing steps and its coarse corrections; both 0 where it has to be left.
    struct Radii {
        double smoothing, correction;
    };

    static constexpr double least_radius = 1e-16;

    std::size_t finest() const { return iterates_.size() - 1; }

    const QuadraticOptions& quadratic_options(std::size_t level) const {
        // Multigrid on a single level factorises.
        const bool alone = transfers_.empty() && options_.finest.preconditioning == Preconditioning::multigrid;
        if (level == 0 && !alone)
            return options_.coarsest;
        return level == transfers_.size() ? options_.finest : options_.smoother;
    }

    /// A level's iterate has begun: smooths, corrects and smooths it, and returns the last radii.
    Radii visit(std::size_t level, Radii radii, double radius_above) {
        ++work_[level].visits;
        radii = smooth(level, radii, radius_above, options_.pre_steps);
        if (level > 0) {
            if (radii.correction > 0 && !context_.cancelled() && is_worth_correcting(level))
                radii = correct(level, radii, radius_above);
            if (iterates_[level]->gradient_norm() > options_.stop.gradient)
                radii = smooth(level, radii, radius_above, options_.post_steps);
        }
        return radii;
    }

    Radii smooth(std::size_t level, Radii radii, double radius_above, int steps) {
        TrustRegionIterate& iterate = *iterates_[level];
        for (int step = 0, tries = 0; step < steps && radii.smoothing > 0; ++step) {
            if (iterate.gradient_norm() < options_.stop.gradient || context_.cancelled())
                break;
            TrialStep trial = iterate.step(radii.smoothing / norm_bound_[level]);
            trial.norm *= norm_bound_[level];
            work_[level].quadratic_iterations += trial.quadratic_iterations;
            ++(trial.accepted ? work_[level].accepted : work_[level].rejected);
            on_tried(level, trial);
            radii.smoothing = next_radius(options_.constants, radii.smoothing, trial);
            if (!options_.separate_radii)
                radii.correction = radii.smoothing;
            radii = bounded(level, radii, radius_above);
            if (!trial.accepted && tries++ < options_.retries)
                --step;
            else
                tries = 0;
        }
        return radii;
    }

    /// Algorithm 4.3: what the level may still move without leaving the radius above.
    Radii bounded(std::size_t level, Radii radii, double radius_above) const {
        if (level == finest())
            return radii;
        const TrustRegionIterate& iterate = *iterates_[level];
        const double moved = norm_on_finest(level, iterate.x() - iterate.start_point());
        const double most = moved > (1 - options_.epsilon) * radius_above ? 0 : radius_above - moved;
        return {std::min(radii.smoothing, most), std::min(radii.correction, most)};
    }

    /// False while corrections rest after rejections, and where the coarse level sees too little of the gradient.
    bool is_worth_correcting(std::size_t level) {
        if (resting_[level] > 0) {
            --resting_[level];
            return false;
        }
        const VecX& gradient = iterates_[level]->gradient();
        return restricted(*prolongations_[level - 1], gradient).norm() >= options_.least_restricted * gradient.norm();
    }

    /// Rests double with every rejection in a row.
    void rest_after(std::size_t level, bool accepted) {
        streak_[level] = accepted ? 0 : streak_[level] + 1;
        resting_[level] = std::min((1 << std::min(streak_[level], 20)) - 1, options_.longest_rest);
    }

    double norm_on_finest(std::size_t level, VecX v) const {
        for (std::size_t l = level; l < finest(); ++l)
            v = prolonged(*prolongations_[l], v);
        return v.norm();
    }

    /// The coarse-level correction of an iterate, accepted by the multilevel ratio (4.11).
    Radii correct(std::size_t level, Radii radii, double radius_above) {
        TrustRegionIterate &fine = *iterates_[level], &coarse = *iterates_[level - 1];
        const ScalarTransfer& s = *prolongations_[level - 1];
        coarse.start(transfers_[level - 1]->project(fine.x()), restricted(s, fine.gradient()));
        if (!std::isfinite(coarse.value()))
            return radii;
        const double radius = radii.correction;
        Radii& remembered = remembered_[level - 1];
        Radii first{radius, radius};
        if (options_.remember_radii)
            first = {std::min(radius, options_.constants.gamma2 * remembered.smoothing),
                     std::min(radius, options_.constants.gamma2 * remembered.correction)};
        const Radii last = visit(level - 1, first, radius);
        if (last.smoothing > 0)
            remembered = last;
        const VecX way = coarse.x() - coarse.start_point();
        if (way.isZero(0))
            return radii;
        const TrialStep trial = try_correction(fine, coarse, way, prolonged(s, way));
        on_tried(level, trial);
        rest_after(level, trial.accepted);
        RmtrLevelWork& work = work_[level];
        ++(trial.accepted ? work.corrections_accepted : work.corrections_rejected);
        TrialStep on_finest = trial;
        on_finest.norm = norm_on_finest(level - 1, way);
        work.largest_correction = std::max(work.largest_correction, on_finest.norm / radius);
        radii.correction = next_radius(options_.constants, radius, on_finest);
        if (!options_.separate_radii)
            radii.smoothing = radii.correction;
        return bounded(level, radii, radius_above);
    }

    static TrialStep try_correction(TrustRegionIterate& fine, TrustRegionIterate& coarse, const VecX& way, VecX step) {
        const NewtonSystem& system = fine.objective().system();
        step = system.scatter(system.gather(step)); // prescribed unknowns stay
        TrialStep trial;
        const double alpha = fine.objective().max_step(fine.x(), step);
        trial.cut = alpha < 1;
        const double reached = trial.cut ? coarse.value_at(coarse.start_point() + alpha * way) : coarse.value();
        trial.predicted = coarse.start_value() - reached;
        VecX end = fine.x() + alpha * step;
        const double value = fine.value_at(end);
        trial.length = alpha * step.norm();
        trial.actual = fine.value() - value;
        const double noise = std::max(fine.noise(fine.value()), coarse.noise(coarse.start_value()));
        trial.ratio = alpha > 0 ? agreement(trial.actual, trial.predicted, noise) : 0;
        trial.accepted = trial.ratio > fine.constants().eta1;
        if (trial.accepted)
            fine.move_to(std::move(end), value);
        return trial;
    }

    void on_tried(std::size_t level, const TrialStep& trial) {
        if (level != finest())
            return;
        hampered_ = hampered_ || !trial.accepted || trial.on_boundary || trial.cut;
        cut_ = cut_ || trial.cut;
        if (!trial.accepted)
            return;
        moved_ = true;
        iterates_[level]->objective().on_accepted(iterates_[level]->x());
    }

    /// Books the work of a cycle and tells of it.
    void report(RmtrSummary& summary, double radius, const std::function<void(const RmtrCycle&)>& observe) {
        for (std::size_t l = 0; l <= finest(); ++l) {
            work_[l].assemblies = iterates_[l]->assemblies() - summary.levels[l].assemblies;
            work_[l].quadratic_solves = iterates_[l]->quadratic_solves() - summary.levels[l].quadratic_solves;
            work_[l].evaluations = iterates_[l]->evaluations() - summary.levels[l].evaluations;
            work_[l].quadratic_products = iterates_[l]->quadratic_products() - summary.levels[l].quadratic_products;
            summary.levels[l] += work_[l];
        }
        const TrustRegionIterate& top = *iterates_[finest()];
        const RmtrCycle cycle{summary.cycles, static_cast<int>(finest()), top.value(), top.gradient_norm(), radius,
                              work_};
        work_.assign(work_.size(), {});
        if (observe)
            observe(cycle);
    }

    std::span<const LevelTransfer* const> transfers_;
    const RmtrOptions& options_;
    Context& context_;
    std::vector<const ScalarTransfer*> prolongations_;
    std::vector<std::unique_ptr<QuadraticSolver>> solvers_;
    std::vector<std::unique_ptr<TrustRegionIterate>> iterates_;
    std::vector<RmtrLevelWork> work_; ///< of the cycle
    std::vector<Radii> remembered_;   ///< the radii each level was left with
    std::vector<double> norm_bound_;  ///< |v|_l <= norm_bound_[l] |v|
    std::vector<int> resting_;        ///< cycles for which the corrections of a level still rest
    std::vector<int> streak_;         ///< rejected corrections in a row
    bool moved_ = false;              ///< the finest iterate, in this cycle
    bool cut_ = false;                ///< max_step cut a step of it, in this cycle
    bool hampered_ = false;           ///< a step of the finest iterate was rejected, or met a bound, in this cycle
};

/// Nested iteration: the coarsest point is improved, its change prolonged and improved on the next level, up to the
/// finest, where what comes of it replaces x if it is better. No level's max_step is asked for the whole change: every
/// step it is made of was within that of its own level, and a straight way to its end may be blocked.
void improve_start(std::span<Objective* const> levels, std::span<const LevelTransfer* const> transfers, VecX& x,
                   const RmtrOptions& options, Context& context, const std::function<void(const RmtrCycle&)>& observe,
                   RmtrSummary& summary) {
    RmtrOptions nested = options;
    nested.stop.max_iterations = options.nested_cycles;
    std::vector<VecX> starts{x};
    for (std::size_t l = transfers.size(); l-- > 0;)
        starts.push_back(transfers[l]->project(starts.back()));
    std::reverse(starts.begin(), starts.end());
    VecX change = VecX::Zero(starts.front().size());
    for (std::size_t l = 0; l < transfers.size() && !context.cancelled(); ++l) {
        VecX y = starts[l] + change;
        if (!(levels[l]->value(y) <= levels[l]->value(starts[l])))
            y = starts[l];
        const RmtrSummary part = Rmtr(levels.first(l + 1), transfers.first(l), nested, context).run(y, observe);
        summary.nested_cycles += part.cycles;
        for (std::size_t k = 0; k <= l; ++k)
            summary.levels[k] += part.levels[k];
        change = prolonged(transfers[l]->prolongation(), y - starts[l]);
    }
    const VecX end = x + change;
    if (levels.back()->value(end) < levels.back()->value(x)) {
        x = end;
        levels.back()->on_accepted(x);
    }
}

} // namespace

RmtrSummary minimize_by_rmtr(std::span<Objective* const> levels, std::span<const LevelTransfer* const> transfers,
                             VecX& x, const RmtrOptions& options, Context& context,
                             const std::function<void(const RmtrCycle&)>& observe) {
    assert(levels.size() == transfers.size() + 1);
    RmtrSummary before;
    before.levels.resize(levels.size());
    if (options.nested_cycles > 0)
        improve_start(levels, transfers, x, options, context, observe, before);
    RmtrSummary summary = Rmtr(levels, transfers, options, context).run(x, observe);
    summary.nested_cycles = before.nested_cycles;
    for (std::size_t l = 0; l < levels.size(); ++l)
        summary.levels[l] += before.levels[l];
    return summary;
}

} // namespace plisse
