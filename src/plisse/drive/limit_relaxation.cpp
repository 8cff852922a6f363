#include <plisse/drive/limit_relaxation.h>

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <plisse/model/shell_problem.h>
#include <plisse/solve/newton.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

constexpr double wanted_room = 0.01;    // of the barrier's width, where the level starts
constexpr double enough_progress = 0.1; // of a round, of the excess; else the barrier is stiffened
constexpr double stiffening = 10;
constexpr int most_rounds = 12; // of one set of vertices
constexpr int iterations_of_round = 10;

using Flags = std::vector<std::uint8_t>;

/// What is held while only new vertices move, while all do that nothing prescribes, and while handles let go.
std::array<Flags, 3> held_unknowns(const Discretization& discretization, int level, const Flags& is_new) {
    const LevelLayout& layout = discretization.layout(level);
    std::array<Flags, 3> held{layout.prescribed, layout.prescribed, Flags(layout.prescribed.size(), 1)};
    for (std::size_t v = 0; v < is_new.size(); ++v)
        if (!is_new[v])
            std::fill_n(held[0].begin() + 3 * static_cast<std::ptrdiff_t>(v), 3, std::uint8_t{1});
    for (const Face& face : layout.body_faces)
        for (int v : face)
            std::fill_n(held[2].begin() + 3 * v, 3, std::uint8_t{0});
    return held;
}

std::string in_words(const Discretization& discretization, int level, const StrainLimit::Excess& excess) {
    return fmt::format("{} faces of level {} could not be brought within their strain limit: one of \"{}\" near "
                       "({:.6g}, {:.6g}, {:.6g}) is stretched to {:.6g}, and its limit is {:.6g}",
                       excess.faces, level, discretization.model().bodies[at(excess.body)].name, excess.place.x(),
                       excess.place.y(), excess.place.z(), excess.stretch, excess.limit);
}

} // namespace

LimitRelaxationResult relax_to_strain_limits(const Discretization& discretization, int level,
                                             const std::vector<std::uint8_t>& is_new, Positions& x, Context& context,
                                             double stiffness_factor) {
    LimitRelaxationResult result;
    const StrainLimit limit(discretization, level);
    StrainLimit::Excess excess = limit.excess(x, wanted_room);
    result.over_limit = excess.faces;
    if (excess.faces == 0)
        return result;
    ShellProblem problem(discretization, level, EnergiesOf::level, context);
    LinearSolver solver;
    NewtonOptions options;
    options.tolerance = discretization.model().solve.tolerance * discretization.model().solve.time_step;
    options.max_iterations = iterations_of_round;
    VecX unknowns = as_vector(x);
    // Surfaces may still be nearer than their contact thickness, which is mended next.
    problem.enforce_thickness(std::min(1.0, 0.9 * problem.least_thickness_share(unknowns)), stiffness_factor);
    for (const Flags& held : held_unknowns(discretization, level, is_new)) {
        double stiffness = 1;
        for (int round = 0; round < most_rounds && excess.faces > 0 && !context.cancelled(); ++round) {
            problem.begin_relaxation(as_positions(unknowns), held, wanted_room, stiffness);
            solver.reset();
            result.iterations += minimize(problem, solver, unknowns, options, context).iterations;
            const double before = excess.share + wanted_room;
            excess = limit.excess(as_positions(unknowns), wanted_room);
            if (excess.faces > 0 && excess.share + wanted_room > (1 - enough_progress) * before)
                stiffness *= stiffening;
        }
    }
    x = as_positions(unknowns);
    result.within = excess.faces == 0;
    if (!result.within)
        result.message = in_words(discretization, level, excess);
    return result;
}

} // namespace plisse
