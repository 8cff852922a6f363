#include "surface_contest.h"

#include <cmath>
#include <ctime>

#include <fmt/format.h>

#include <plisse/base/parallel.h>
#include <plisse/drive/surface_stepper.h>
#include <plisse/linalg/condition.h>

#include "child_process.h"

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

SurfaceSolver solver_of(Way way) {
    switch (way) {
    case Way::trust_region:
        return SurfaceSolver::trust_region;
    case Way::newton:
        return SurfaceSolver::newton;
    case Way::damped_newton:
        return SurfaceSolver::damped_newton;
    case Way::linearised:
        return SurfaceSolver::linearised;
    case Way::rmtr:
    case Way::least_squares:
    case Way::paper:
        break;
    }
    return SurfaceSolver::rmtr;
}

/// The first step from rest.
SurfaceStep first_step(const SubdivisionModel& model, double time_step) {
    SurfaceStep step;
    step.t = step.time_step = time_step;
    step.inertial = model.levels.rest(model.levels.level_count() - 1);
    return step;
}

/// Processor time of this process, s: on a machine that others use too, it says more than the clock.
double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Cancels a context once processor time is over.
class Deadline {
public:
    Deadline(double seconds, Context& context) : seconds_(seconds), context_(context) {}
    void check() {
        if (seconds() < seconds_ || context_.cancelled())
            return;
        passed_ = true;
        context_.cancel();
    }
    bool passed() const { return passed_; }
    double seconds() const { return processor_seconds() - start_; }
    double wall_seconds() const { return watch_.seconds(); }

private:
    double seconds_, start_ = processor_seconds();
    Context& context_;
    Stopwatch watch_;
    bool passed_ = false;
};

Json solved(const SubdivisionModel& model, double time_limit, Context& context) {
    Deadline deadline(time_limit, context);
    SurfaceStepper stepper(model, context);
    const SurfaceStep step = first_step(model, 1);
    VecX x = as_vector(step.inertial);
    const SurfaceOutcome outcome = stepper.solve(step, x, [&](const SurfaceIteration&) { deadline.check(); });
    const double seconds = deadline.seconds(), wall_seconds = deadline.wall_seconds();
    return {{"unknowns", x.size()},
            {"converged", is_converged(outcome.end)},
            {"timed_out", deadline.passed()},
            {"message", outcome.message},
            {"iterations", outcome.iterations},
            {"gradient_norm", outcome.gradient_norm},
            {"value", stepper.finest().value(x)},
            {"seconds", seconds},
            {"wall_seconds", wall_seconds},
            {"assembly_units", assembly_units(outcome.work)},
            {"quadratic_units", quadratic_units(outcome.work)},
            {"product_units", product_units(outcome.work)}};
}

/// By (7.1): other solvers than those of trust regions end by tests of their own.
bool converges(SurfaceStepper& stepper, bool has_radius, const SurfaceStep& step, Deadline& deadline) {
    VecX x = as_vector(step.inertial);
    const SurfaceOutcome outcome = stepper.solve(step, x, [&](const SurfaceIteration&) { deadline.check(); });
    const bool is_small = outcome.gradient_norm < TrustRegionStop().gradient;
    return is_small || (has_radius && is_converged(outcome.end));
}

Json largest_step(const SubdivisionModel& model, double time_limit, Context& context) {
    Deadline deadline(time_limit, context);
    SurfaceStepper stepper(model, context);
    const SurfaceSolver solver = model.solve.rmtr.solver;
    const bool has_radius = solver == SurfaceSolver::rmtr || solver == SurfaceSolver::trust_region;
    Json found = {{"unknowns", stepper.finest().system().vertex_count() * 3}, {"time_step", 0}, {"timed_out", false}};
    for (double decade = 1; decade > 0.9 * smallest_step; decade /= 10)
        for (const double share : {1.0, 0.5, 0.2}) {
            const double time_step = share * decade;
            if (time_step < 0.9 * smallest_step)
                break;
            if (converges(stepper, has_radius, first_step(model, time_step), deadline)) {
                found["time_step"] = time_step;
                return found;
            }
            if (context.cancelled()) {
                found["timed_out"] = deadline.passed();
                return found;
            }
        }
    return found;
}

} // namespace

const char* way_name(Way way) {
    switch (way) {
    case Way::rmtr:
        return "rmtr";
    case Way::least_squares:
        return "rmtr, least squares";
    case Way::paper:
        return "rmtr as published";
    case Way::trust_region:
        return "trust region";
    case Way::newton:
        return "line search";
    case Way::damped_newton:
        return "damped Newton";
    case Way::linearised:
        break;
    }
    return "linearised";
}

SubdivisionModel contest_model(Scenario scenario, Way way, int levels) {
    SubdivisionModel model = scenario_model(scenario, levels);
    RmtrSettings& settings = model.solve.rmtr;
    settings.solver = solver_of(way);
    if (way == Way::least_squares)
        settings.projection = SurfaceProjection::least_squares;
    if (way == Way::paper) {
        settings.smoother = settings.finest_smoother = SurfaceSmoother::plain;
        settings.radii = SurfaceRadii::single;
        settings.nested_iteration = false;
    }
    return model;
}

SurfaceRun run_contestant(Scenario scenario, Way way, int levels, const ContestRules& rules, Context& context) {
    SurfaceRun run;
    run.scenario = scenario;
    run.way = way;
    run.levels = levels;
    const Json json = in_child_process(
        [&] {
            const ThreadLimit limit(rules.threads);
            return solved(contest_model(scenario, way, levels), rules.time_limit, context);
        },
        context);
    if (json.contains("error")) {
        run.message = json.at("error").get<std::string>();
        return run;
    }
    json.at("unknowns").get_to(run.unknowns);
    json.at("converged").get_to(run.converged);
    json.at("timed_out").get_to(run.timed_out);
    json.at("message").get_to(run.message);
    json.at("iterations").get_to(run.iterations);
    // What is not a number is null in JSON.
    run.gradient_norm = json.at("gradient_norm").is_null() ? NAN : json.at("gradient_norm").get<double>();
    run.value = json.at("value").is_null() ? NAN : json.at("value").get<double>();
    json.at("seconds").get_to(run.seconds);
    json.at("wall_seconds").get_to(run.wall_seconds);
    json.at("assembly_units").get_to(run.assembly_units);
    json.at("quadratic_units").get_to(run.quadratic_units);
    json.at("product_units").get_to(run.product_units);
    json.at("peak_memory_bytes").get_to(run.peak_memory);
    if (run.timed_out)
        run.message = fmt::format("cut short after {:g} s and {} iterations, with |g| = {:.3g}", rules.time_limit,
                                  run.iterations, run.gradient_norm);
    return run;
}

Json run_json(const SurfaceRun& run) {
    return {{"scenario", scenario_name(run.scenario)},
            {"way", way_name(run.way)},
            {"levels", run.levels},
            {"unknowns", run.unknowns},
            {"converged", run.converged},
            {"message", run.message},
            {"iterations", run.iterations},
            {"gradient_norm", run.gradient_norm},
            {"value", run.value},
            {"seconds", run.seconds},
            {"wall_seconds", run.wall_seconds},
            {"peak_memory_bytes", run.peak_memory},
            {"assembly_units", run.assembly_units},
            {"quadratic_units", run.quadratic_units},
            {"product_units", run.product_units}};
}

LargestStep find_largest_step(Scenario scenario, Way way, int levels, const ContestRules& rules, Context& context) {
    const Json json = in_child_process(
        [&] {
            const ThreadLimit limit(rules.threads);
            SubdivisionModel model = contest_model(scenario, way, levels);
            if (way == Way::damped_newton)
                model.solve.rmtr.max_cycles = 500; // near the solution a step leaves 0.7 of the gradient
            return largest_step(model, rules.time_limit, context);
        },
        context);
    LargestStep found{scenario, way, 0, 0, true};
    if (!json.contains("error")) {
        json.at("unknowns").get_to(found.unknowns);
        json.at("time_step").get_to(found.time_step);
        json.at("timed_out").get_to(found.timed_out);
    }
    return found;
}

Condition trampoline_condition(int levels, bool boundary_variables, double penalty, const ContestRules& rules,
                               Context& context) {
    const Json json = in_child_process(
        [&]() -> Json {
            const ThreadLimit limit(rules.threads);
            SubdivisionModel model = scenario_model(Scenario::trampoline, levels, boundary_variables);
            model.solve.rmtr.solver = SurfaceSolver::trust_region;
            if (penalty > 0)
                model.solve.rmtr.penalty = penalty;
            SurfaceStepper stepper(model, context);
            const SurfaceStep step = first_step(model, 1);
            stepper.begin_step(step);
            SubdivisionProblem& finest = stepper.finest();
            finest.assemble(as_vector(step.inertial), finest.system(), false);
            return {{"unknowns", 3 * finest.system().vertex_count()}, {"number", condition_number(finest.system())}};
        },
        context);
    Condition condition;
    if (json.contains("error"))
        return condition;
    json.at("unknowns").get_to(condition.unknowns);
    if (const Json& number = json.at("number"); !number.is_null())
        number.get_to(condition.number);
    return condition;
}

} // namespace plisse
