#pragma once

#include <functional>
#include <string>

#include <plisse/base/context.h>
#include <plisse/linalg/linear_solver.h>
#include <plisse/solve/objective.h>

namespace plisse {

struct NewtonOptions {
    double tolerance = 1e-4;           ///< converged when the largest nodal step |d_i| is at most this, m
    double target_tolerance = 1e-12;   ///< prescribed unknowns count as arrived within this, m
    int max_iterations = 1000;         ///< >= 1
    double sufficient_decrease = 1e-4; ///< Armijo constant, in (0, 0.5)
    int max_halvings = 40;             ///< of one line search
    int max_short_steps = 30;          ///< stalled after this many steps in a row shorter than short_step
    double short_step = 1e-5;
    double cut_step = 0.01; ///< steps cut below this share of their length are worth a word
    int most_cut_steps = 5; ///< in a row, before that word is said and a script is blocked
};

enum class NewtonEnd {
    converged,
    stalled,       ///< steps became too short, or no decrease could be found
    blocked,       ///< the free unknowns are at their minimum, but the prescribed ones cannot go on
    iteration_cap, ///< max_iterations were done
    cancelled,
};

struct NewtonIteration {
    int iteration = 0;
    double value = 0;       ///< after the step
    double step_norm = 0;   ///< largest nodal |d_i|, m
    double step_length = 0; ///< alpha; above 1 where H was too stiff along the step
    double remaining = 0;   ///< largest distance of a prescribed vertex to its target before the step, m
    StepLimit limit;        ///< what cuts the steps, said once when several in a row are cut short; else empty
};

struct NewtonSummary {
    NewtonEnd end = NewtonEnd::converged;
    std::string message;   ///< why it ended, in words
    int iterations = 0;    ///< steps taken
    int evaluations = 0;   ///< of the value
    double step_norm = 0;  ///< of the last direction, m
    double remaining = 0;  ///< largest distance of a prescribed vertex to its target, m
    int worst_vertex = -1; ///< where the last direction is largest
};

/// Projected Newton with a line search (IPC, Li et al. 2020, algorithm 1). Prescribed unknowns take the step to their
/// targets and the free ones the Newton step that goes with it (static condensation of H); while they are on their
/// way, the line search works on the exact penalty value(x) + weight * (remaining share), with a weight raised to what
/// the quadratic model asks for. So a script is followed as fast as feasibility allows and never faster. Where steps
/// are cut again and again, they are taken back and the script is held until the free unknowns are at their minimum,
/// then driven on; drives that lead nowhere end in `blocked`. Calls observe after each step, and on_progress through
/// it.
NewtonSummary minimize(Objective& objective, LinearSolver& solver, VecX& x, const NewtonOptions& options,
                       Context& context, const std::function<void(const NewtonIteration&)>& observe = {});

/// Largest Euclidean norm over the vertices of a vector of 3 per vertex, and where it is.
double largest_nodal_norm(const VecX& vector, int* where = nullptr);

} // namespace plisse
