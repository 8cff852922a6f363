#include <plisse/drive/surface_stepper.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <plisse/drive/friction_updates.h>
#include <plisse/linalg/linear_solver.h>
#include <plisse/solve/newton.h>
#include <plisse/solve/trust_region.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Corrections by S, points by least squares.
class LeastSquaresTransfer final : public LevelTransfer {
public:
    LeastSquaresTransfer(ScalarTransfer prolongation, LeastSquaresProjection projection)
        : prolongation_(std::move(prolongation)), projection_(std::move(projection)) {}
    const ScalarTransfer& prolongation() const override { return prolongation_; }
    VecX project(const VecX& fine) const override {
        const Positions coarse = projection_.apply(as_positions(fine));
        return as_vector(coarse);
    }

private:
    ScalarTransfer prolongation_;
    LeastSquaresProjection projection_;
};

/// Tells the coarser level where the finer one's surface is whenever a point is taken down to it.
class ContactTransfer final : public LevelTransfer {
public:
    ContactTransfer(std::unique_ptr<LevelTransfer> map, const LevelContact& fine, LevelContact& coarse)
        : map_(std::move(map)), fine_(fine), coarse_(coarse) {}
    const ScalarTransfer& prolongation() const override { return map_->prolongation(); }
    VecX project(const VecX& fine) const override {
        VecX coarse = map_->project(fine);
        coarse_.correct(as_positions(coarse), fine_.limit_points(as_positions(fine)));
        return coarse;
    }

private:
    std::unique_ptr<LevelTransfer> map_;
    const LevelContact& fine_;
    LevelContact& coarse_;
};

bool may_touch(const SubdivisionModel& model) {
    return model.contact.self || model.obstacles.face_count() > 0;
}

/// Of the finest limit points, from every level's variables.
std::vector<VertexWeights> maps_to_surface(const SubdivisionModel& model) {
    const int finest = model.levels.level_count() - 1;
    std::vector<VertexWeights> maps(at(finest + 1));
    maps.back() = model.levels.limit_points(finest).weights;
    for (int l = finest - 1; l >= 0; --l)
        maps[at(l)] = maps[at(l + 1)] * model.levels.subdivision(l);
    return maps;
}

std::unique_ptr<LevelTransfer> transfer_between(const SubdivisionModel& model, int level) {
    const SubdivisionLevels& levels = model.levels;
    if (model.solve.rmtr.projection == SurfaceProjection::least_squares)
        return std::make_unique<LeastSquaresTransfer>(levels.subdivision(level),
                                                      levels.least_squares_projection(level));
    return std::make_unique<SparseTransfer>(levels.subdivision(level), levels.projection(level));
}

QuadraticOptions smoothing_by(SurfaceSmoother smoother) {
    QuadraticOptions options;
    options.method = QuadraticMethod::conjugate_gradients;
    switch (smoother) {
    case SurfaceSmoother::plain:
        options.preconditioning = Preconditioning::none;
        break;
    case SurfaceSmoother::block_jacobi:
        options.preconditioning = Preconditioning::block_jacobi;
        break;
    case SurfaceSmoother::gauss_seidel:
        options.preconditioning = Preconditioning::block_gauss_seidel;
        break;
    case SurfaceSmoother::multigrid:
        options.preconditioning = Preconditioning::multigrid;
        break;
    }
    return options;
}

TrustRegionEnd end_of(NewtonEnd end) {
    switch (end) {
    case NewtonEnd::converged:
        return TrustRegionEnd::small_change;
    case NewtonEnd::iteration_cap:
        return TrustRegionEnd::iteration_cap;
    case NewtonEnd::cancelled:
        return TrustRegionEnd::interrupted;
    case NewtonEnd::stalled:
    case NewtonEnd::blocked:
        break;
    }
    return TrustRegionEnd::stalled;
}

RmtrLevelWork work_of_newton_steps(int steps) {
    RmtrLevelWork work;
    work.visits = work.accepted = work.assemblies = work.quadratic_solves = work.quadratic_iterations = steps;
    work.quadratic_products = steps * products_of_direct_solve;
    return work;
}

double gradient_norm(Objective& objective, const VecX& x) {
    VecX gradient;
    objective.gradient(x, gradient);
    return gradient.norm();
}

} // namespace

void SurfaceOutcome::go_on(const SurfaceOutcome& part) {
    end = part.end;
    message = part.message;
    iterations += part.iterations;
    gradient_norm = part.gradient_norm;
    work.resize(std::max(work.size(), part.work.size()));
    for (std::size_t l = 0; l < part.work.size(); ++l)
        work[l] += part.work[l];
}

SurfaceStepper::SurfaceStepper(const SubdivisionModel& model, Context& context)
    : model_(model), settings_(model.solve.rmtr), context_(context) {
    std::vector<HeldPlaces> held = held_places(model);
    const double penalty = boundary_penalty(model);
    const int finest = model.levels.level_count() - 1;
    if (may_touch(model))
        contact_ = std::make_unique<SurfaceContact>(model, context);
    const std::vector<VertexWeights> to_surface = maps_to_surface(model);
    limit_weights_ = to_surface.back();
    // Solvers of the finest level alone need no others.
    const int first = settings_.solver == SurfaceSolver::rmtr ? 0 : finest;
    for (int l = first; l <= finest; ++l)
        problems_.push_back(std::make_unique<SubdivisionProblem>(model, l, std::move(held[at(l)]), penalty, context,
                                                                 contact_.get(), to_surface[at(l)]));
    for (int l = first; l < finest; ++l) {
        std::unique_ptr<LevelTransfer> map = transfer_between(model, l);
        if (contact_)
            map = std::make_unique<ContactTransfer>(std::move(map), *problems_[at(l + 1 - first)]->contact(),
                                                    *problems_[at(l - first)]->contact());
        transfers_.push_back(std::move(map));
    }
}

Positions SurfaceStepper::obstacles() const {
    return contact_ ? contact_->obstacles() : Positions(3, 0);
}

FrictionMemory SurfaceStepper::friction_memory() const {
    return contact_ ? contact_->friction().memory() : FrictionMemory();
}

void SurfaceStepper::place_obstacles(double t) {
    if (contact_)
        contact_->place_obstacles(t);
}

Positions SurfaceStepper::limit_points(const VecX& x) const {
    return as_positions(x) * limit_weights_.transpose();
}

void SurfaceStepper::begin_step(const SurfaceStep& step) {
    std::vector<Positions> inertial(problems_.size());
    inertial.back() = step.inertial;
    for (std::size_t l = problems_.size() - 1; step.time_step > 0 && l > 0; --l)
        inertial[l - 1] = as_positions(transfers_[l - 1]->project(as_vector(inertial[l])));
    for (std::size_t l = 0; l < problems_.size(); ++l)
        problems_[l]->begin_step(step, std::move(inertial[l]));
}

SurfaceOutcome SurfaceStepper::solve(const SurfaceStep& step, VecX& x, const Observer& observe) {
    begin_step(step);
    if (!contact_)
        return minimize(x, settings_.max_cycles, true, observe);
    contact_->begin_step(limit_points(x), step.rubbing, step.grips ? Friction::first_grip : 1);
    SurfaceOutcome outcome = minimize_with_obstacles(step.t, x, observe);
    bring_friction_to_rest(x, outcome, observe);
    return outcome;
}

SurfaceOutcome SurfaceStepper::minimize(VecX& x, int most_cycles, bool thorough, const Observer& observe) {
    constexpr double damping = 0.3; // the paper's
    for (const auto& problem : problems_)
        if (problem->contact())
            problem->contact()->stand_alone();
    switch (settings_.solver) {
    case SurfaceSolver::trust_region:
        return by_trust_region(x, most_cycles, observe);
    case SurfaceSolver::newton:
        return by_line_search(x, most_cycles, observe);
    case SurfaceSolver::damped_newton:
        return by_fixed_steps(x, damping, most_cycles, observe);
    case SurfaceSolver::linearised:
        return by_fixed_steps(x, 1, 1, observe);
    case SurfaceSolver::rmtr:
        break;
    }
    return by_rmtr(x, most_cycles, thorough && settings_.nested_iteration, observe);
}

SurfaceOutcome SurfaceStepper::minimize_with_obstacles(double t, VecX& x, const Observer& observe) {
    constexpr int cycles_on_the_way = 5;
    constexpr int most_rounds_in_place = 30; // without a thousandth of the rest of the way
    constexpr double least_share = 1e-3;
    SurfaceOutcome whole;
    for (int in_place = 0;;) {
        const double share = contact_->move_obstacles(limit_points(x), t);
        if (share == 1) {
            whole.go_on(minimize(x, settings_.max_cycles, whole.iterations == 0, observe));
            return whole;
        }
        in_place = share < least_share ? in_place + 1 : 0;
        const SurfaceOutcome part = minimize(x, std::min(cycles_on_the_way, settings_.max_cycles), false, observe);
        whole.go_on(part);
        if (part.end == TrustRegionEnd::interrupted || part.end == TrustRegionEnd::infeasible)
            return whole;
        if (in_place == most_rounds_in_place) {
            whole.end = TrustRegionEnd::stalled;
            whole.message = contact_->held_up(limit_points(x), t);
            return whole;
        }
    }
}

void SurfaceStepper::bring_friction_to_rest(VecX& x, SurfaceOutcome& outcome, const Observer& observe) {
    for (int update = 0; is_converged(outcome.end); ++update) {
        if (!contact_->update_friction(limit_points(x), friction_share(update)))
            return;
        const SurfaceOutcome part = minimize(x, settings_.max_cycles, false, observe);
        outcome.go_on(part);
        if (part.iterations == 0)
            return;
        if (update == most_friction_updates) {
            outcome.end = TrustRegionEnd::iteration_cap;
            outcome.message = fmt::format("the forces of friction have not come to rest in {} updates", update);
        }
    }
}

SurfaceOutcome SurfaceStepper::by_rmtr(VecX& x, int most_cycles, bool nested, const Observer& observe) {
    RmtrOptions options;
    options.stop.max_iterations = most_cycles;
    options.smoother = smoothing_by(settings_.smoother);
    options.finest = smoothing_by(settings_.finest_smoother);
    if (settings_.finest_smoother == SurfaceSmoother::multigrid)
        options.finest = newton_by_multigrid();
    if (settings_.radii == SurfaceRadii::single) {
        options.separate_radii = false;
        options.longest_rest = 0;
        options.least_restricted = 0;
    }
    options.nested_cycles = nested ? settings_.max_cycles : 0;
    std::vector<Objective*> levels;
    for (const auto& problem : problems_)
        levels.push_back(problem.get());
    std::vector<const LevelTransfer*> transfers;
    for (const auto& transfer : transfers_)
        transfers.push_back(transfer.get());
    const RmtrSummary summary = minimize_by_rmtr(levels, transfers, x, options, context_, [&](const RmtrCycle& cycle) {
        if (observe)
            observe({cycle.cycle, cycle.finest_level, cycle.value, cycle.gradient_norm, cycle.radius});
    });
    return {summary.end, summary.message, summary.cycles, summary.gradient_norm, summary.levels};
}

SurfaceOutcome SurfaceStepper::by_trust_region(VecX& x, int most, const Observer& observe) {
    TrustRegionOptions options;
    options.stop.max_iterations = most;
    options.quadratic.method = QuadraticMethod::dogleg;
    const int finest = model_.levels.level_count() - 1;
    const TrustRegionSummary summary =
        minimize_by_trust_region(this->finest(), x, options, context_, [&](const TrustRegionIteration& iteration) {
            if (observe)
                observe(
                    {iteration.iteration, finest, iteration.value, iteration.gradient_norm, iteration.trial.radius});
        });
    RmtrLevelWork work;
    work.visits = summary.iterations;
    work.accepted = summary.accepted;
    work.rejected = summary.iterations - summary.accepted;
    work.assemblies = summary.assemblies;
    work.quadratic_solves = work.quadratic_iterations = summary.quadratic_solves;
    work.quadratic_products = summary.quadratic_products;
    work.evaluations = summary.evaluations;
    return {summary.end, summary.message, summary.iterations, summary.gradient_norm, {work}};
}

SurfaceOutcome SurfaceStepper::by_line_search(VecX& x, int most, const Observer& observe) {
    NewtonOptions options;
    options.tolerance = 1e-9; // m
    options.max_iterations = most;
    LinearSolver solver;
    const int level = model_.levels.level_count() - 1;
    const NewtonSummary summary =
        plisse::minimize(finest(), solver, x, options, context_, [&](const NewtonIteration& iteration) {
            if (observe)
                observe({iteration.iteration, level, iteration.value, iteration.step_norm, iteration.step_length});
        });
    return {end_of(summary.end),
            summary.message,
            summary.iterations,
            gradient_norm(finest(), x),
            {work_of_newton_steps(summary.iterations)}};
}

SurfaceOutcome SurfaceStepper::by_fixed_steps(VecX& x, double factor, int most, const Observer& observe) {
    const TrustRegionStop stop;
    LinearSolver solver;
    SurfaceOutcome outcome;
    VecX gradient;
    finest().gradient(x, gradient);
    for (outcome.gradient_norm = gradient.norm(); !(outcome.gradient_norm < stop.gradient);
         outcome.gradient_norm = gradient.norm()) {
        const bool is_finite = std::isfinite(outcome.gradient_norm);
        if (!is_finite || outcome.iterations == most || context_.cancelled()) {
            outcome.end = !is_finite             ? TrustRegionEnd::stalled
                          : context_.cancelled() ? TrustRegionEnd::interrupted
                                                 : TrustRegionEnd::iteration_cap;
            break;
        }
        NewtonSystem& system = finest().system();
        finest().assemble(x, system, false);
        solver.factorize(system);
        const VecX step = factor * system.scatter(solver.solve(system, -system.gather(gradient)));
        x += finest().max_step(x, step) * step;
        ++outcome.iterations;
        finest().gradient(x, gradient);
        if (observe)
            observe({outcome.iterations, model_.levels.level_count() - 1, finest().value(x), gradient.norm(), factor});
    }
    outcome.work = {work_of_newton_steps(outcome.iterations)};
    outcome.message = fmt::format("{} after {} steps, with |g| = {:.3g}", in_words(outcome.end), outcome.iterations,
                                  outcome.gradient_norm);
    return outcome;
}

} // namespace plisse
