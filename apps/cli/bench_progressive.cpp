#include "bench_progressive.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/base/parallel.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/drive/run.h>
#include <plisse/scene/build_model.h>
#include <plisse/scene/whole_file.h>
#include <plisse/spatial/box.h>

#include "bench_scenes.h"
#include "console.h"
#include "exit_status.h"
#include "interrupt.h"

namespace plisse {

namespace {

/// Keeps the hierarchy and the last state of the coarsest level.
class LastStates : public Recorder {
public:
    void on_hierarchy(const Hierarchy& hierarchy) override { hierarchy_ = hierarchy; }
    void on_frame(const Frame& frame) override {
        if (frame.level == 0)
            coarsest_ = *frame.positions;
    }
    /// The last state of level 0, shown on the finest mesh.
    Positions shown_on_finest(ProlongationOperator kind) const {
        return prolongation_to_finest(hierarchy_, 0, kind).apply(coarsest_);
    }

private:
    Hierarchy hierarchy_;
    Positions coarsest_;
};

/// One run with what is compared of it.
struct Contestant {
    std::string label;
    RunReport report;
    double seconds = 0;
    Positions preview; ///< level 0 on the finest mesh
    Positions result;  ///< of the last level
    bool converged() const { return report.status == RunStatus::converged && report.intersecting_pairs == 0; }
};

/// Runs the model. An interruption ends the whole benchmark.
Contestant compete(const std::string& label, const Model& model, Context& context) {
    context.on_message(label);
    Contestant contestant;
    contestant.label = label;
    LastStates states;
    const Stopwatch watch;
    RunResult result = run(model, {}, states, context);
    if (context.cancelled())
        throw ExitStatus{ExitCode::interrupted};
    contestant.seconds = watch.seconds();
    contestant.report = std::move(result.report);
    contestant.result = std::move(result.positions);
    contestant.preview = states.shown_on_finest(model.hierarchy.prolongation);
    return contestant;
}

/// Both methods run with each of these multiples of the scene's time step: larger steps are fewer and harder. The last
/// ones take the whole script in a few steps, which no longer follows it.
constexpr double step_factors[] = {1, 4, 8, 20};

struct Contest {
    std::vector<Contestant> progressive, direct;
    Contestant direct_coarse;
    double diagonal = 0; ///< m
};

/// The fastest of those that converged, or none.
const Contestant* fastest_of(const std::vector<Contestant>& contestants) {
    const Contestant* fastest = nullptr;
    for (const Contestant& contestant : contestants)
        if (contestant.converged() && (!fastest || contestant.seconds < fastest->seconds))
            fastest = &contestant;
    return fastest;
}

std::vector<Contestant> compete_with_steps(const std::string& label, Model model, Context& context) {
    const double time_step = model.solve.time_step;
    std::vector<Contestant> contestants;
    for (double factor : step_factors) {
        model.solve.time_step = factor * time_step;
        contestants.push_back(compete(fmt::format("{}, step {:g} s", label, model.solve.time_step), model, context));
    }
    return contestants;
}

Contest hold_contest(Model model, Context& context) {
    Contest contest;
    contest.diagonal = bounding_box(model.mesh.positions).diagonal();
    contest.progressive = compete_with_steps("progressive", model, context);
    model.solve.method = Method::direct;
    contest.direct = compete_with_steps("direct", model, context);
    model.solve.level = 0;
    contest.direct_coarse = compete("direct on level 0", model, context);
    return contest;
}

void print_row(const std::string& label, int vertices, int iterations, double seconds, const PhaseTimes& phases,
               const std::string& status) {
    fmt::print("{:<32} {:>8} {:>10} {:>8.2f}", label, vertices, iterations, seconds);
    for (double phase : phases.seconds)
        fmt::print(" {:>12.2f}", phase);
    fmt::print("  {}\n", status);
}

/// The levels [first, last) of a run as one row.
void print_levels(const std::string& label, const Contestant& contestant, std::size_t first, std::size_t last,
                  double seconds, const std::string& status) {
    const auto& levels = contestant.report.levels;
    int iterations = 0, vertices = 0;
    PhaseTimes phases;
    for (std::size_t l = first; l < std::min(last, levels.size()); ++l) {
        iterations += levels[l].newton_iterations;
        vertices = levels[l].vertices;
        phases += levels[l].seconds;
    }
    print_row(label, vertices, iterations, seconds, phases, status);
}

double preview_seconds(const Contestant& progressive) {
    return progressive.report.levels.front().total_seconds;
}

/// Largest distance between two states of one mesh, as a share of the scene's diagonal.
double largest_difference(const Positions& a, const Positions& b, double diagonal) {
    return (a - b).colwise().norm().maxCoeff() / diagonal;
}

void print_table(const Contest& contest) {
    fmt::print("{:<32} {:>8} {:>10} {:>8}", "", "vertices", "iterations", "seconds");
    for (int phase = 0; phase < phase_count; ++phase)
        fmt::print(" {:>12}", phase_name(static_cast<Phase>(phase)));
    fmt::print("\n");
    const auto print_whole = [](const Contestant& c) {
        print_levels(c.label, c, 0, c.report.levels.size(), c.seconds,
                     std::string(run_status_name(c.report.status)) +
                         (c.report.message.empty() ? "" : ": " + c.report.message));
    };
    for (const Contestant& progressive : contest.progressive) {
        print_whole(progressive);
        const double preview = preview_seconds(progressive);
        print_levels("  preview, level 0", progressive, 0, 1, preview, "");
        print_levels("  hierarchy and refinement", progressive, 1, progressive.report.levels.size(),
                     progressive.seconds - preview, "");
    }
    for (const Contestant& direct : contest.direct)
        print_whole(direct);
    print_whole(contest.direct_coarse);
}

/// Of the fastest run of each method.
nlohmann::ordered_json ratios_of(const Contest& contest, const Contestant& progressive, const Contestant& direct) {
    const double preview = preview_seconds(progressive);
    nlohmann::ordered_json ratios;
    ratios["direct_over_progressive"] = direct.seconds / progressive.seconds;
    ratios["direct_over_preview"] = direct.seconds / preview;
    ratios["direct_coarse_over_preview"] = contest.direct_coarse.seconds / preview;
    ratios["preview_over_progressive"] = preview / progressive.seconds;
    ratios["difference_of_finest_states"] = largest_difference(progressive.result, direct.result, contest.diagonal);
    ratios["preview_to_finest_state"] = largest_difference(progressive.preview, progressive.result, contest.diagonal);
    ratios["direct_coarse_to_finest_state"] =
        largest_difference(contest.direct_coarse.preview, progressive.result, contest.diagonal);
    return ratios;
}

void print_ratios(const nlohmann::ordered_json& ratios) {
    fmt::print("\nratios of the fastest of each method (differences and \"to\": largest distance over the scene's "
               "diagonal)\n");
    for (const auto& [name, value] : ratios.items())
        fmt::print("  {:<32} {:.4g}\n", name, value.get<double>());
}

} // namespace

void run_progressive_bench(const BenchArguments& arguments) {
    const Scene scene = bench_scene(arguments.name, arguments.quick);
    const ThreadLimit limit(arguments.threads);
    Console console(progress_style("auto", false));
    const InterruptGuard guard(console);
    const Contest contest = hold_contest(build_model(scene, console), console);
    console.clear_bar();
    print_table(contest);
    const Contestant* progressive = fastest_of(contest.progressive);
    const Contestant* direct = fastest_of(contest.direct);
    if (!progressive || !direct) {
        fmt::print("\nno ratios: {} did not converge with any time step\n", progressive ? "direct" : "progressive");
        throw ExitStatus{ExitCode::failed};
    }
    const nlohmann::ordered_json ratios = ratios_of(contest, *progressive, *direct);
    print_ratios(ratios);
    if (arguments.json.empty())
        return;
    const nlohmann::ordered_json json = {{"benchmark", arguments.name},
                                         {"quick", arguments.quick},
                                         {"threads", limit.threads()},
                                         {"vertices", progressive->report.levels.back().vertices},
                                         {"ratios", ratios}};
    write_file_atomically(arguments.json, json.dump(2) + "\n");
}

} // namespace plisse
