#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>

#include <nlohmann/json.hpp>

#include <plisse/base/context.h>

#include "bench_surfaces.h"

namespace plisse {

/// How a step is solved in `plisse bench rmtr`.
enum class Way {
    rmtr,          ///< as plisse does
    least_squares, ///< the same with points projected by least squares
    paper, ///< recursive multilevel trust region as published: plain smoothing, one radius, from the finest level
    trust_region, ///< one level with a factorised Hessian
    newton,       ///< with line search
    damped_newton,
    linearised,
};
inline constexpr std::array ways_of_figure_10{Way::trust_region, Way::rmtr, Way::newton, Way::damped_newton,
                                              Way::linearised};
const char* way_name(Way way);
/// The scenario's model to be solved that way, with so many iterations or cycles at most.
SubdivisionModel contest_model(Scenario scenario, Way way, int levels);

/// What every contestant is held to.
struct ContestRules {
    double time_limit = 0; ///< s of processor time, of all threads
    int threads = 0;       ///< 0: one a processor
};

/// One step of a second, and what it took.
struct SurfaceRun {
    Scenario scenario = Scenario::trampoline;
    Way way = Way::rmtr;
    int levels = 0, unknowns = 0;
    bool converged = false, timed_out = false;
    std::string message; ///< why it ended, in words
    int iterations = 0;  ///< or cycles on the finest level
    double gradient_norm = 0;
    double value = 0;              ///< J, at the end
    double seconds = 0;            ///< of processor time, of all threads: set-up and solution, not the making of meshes
    double wall_seconds = 0;       ///< the same on the clock
    std::uint64_t peak_memory = 0; ///< bytes, of the whole process
    double assembly_units = 0, quadratic_units = 0, product_units = 0; ///< work units, see RmtrLevelWork
};
/// Runs in a process of its own; the context is cancelled where it was interrupted.
SurfaceRun run_contestant(Scenario scenario, Way way, int levels, const ContestRules& rules, Context& context);
nlohmann::ordered_json run_json(const SurfaceRun& run);

/// The largest of the time steps 1, 0.5, 0.2, 0.1 ... 1e-8 s with which the first step ends by (7.1).
struct LargestStep {
    Scenario scenario = Scenario::trampoline;
    Way way = Way::rmtr;
    int unknowns = 0;
    double time_step = 0; ///< s; 0: none
    bool timed_out = false;
};
LargestStep find_largest_step(Scenario scenario, Way way, int levels, const ContestRules& rules, Context& context);
constexpr double smallest_step = 1e-8; ///< s

struct Condition {
    int unknowns = 0;
    double number = std::numeric_limits<double>::infinity(); ///< infinite where no factorisation succeeds
};
/// Of H of a trampoline at rest, in the paper's variables or with those of the boundary curve. penalty: beta, N/m^3; 0
/// for h^-5.
Condition trampoline_condition(int levels, bool boundary_variables, double penalty, const ContestRules& rules,
                               Context& context);

} // namespace plisse
