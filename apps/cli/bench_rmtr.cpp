#include "bench_rmtr.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <plisse/scene/whole_file.h>

#include "console.h"
#include "exit_status.h"
#include "interrupt.h"
#include "log_plot.h"
#include "rmtr_tables.h"

namespace plisse {

namespace {

/// How far the bench goes.
struct BenchSizes {
    int levels;            ///< of all scenarios
    int levels_of_some;    ///< of all but the re-entrant corner
    int levels_of_paper;   ///< of the trampoline by the method as published: it takes long, and longer elsewhere
    int levels_of_table_8; ///< projections
    int levels_of_figures; ///< 9, over beta, and 10
    double time_limit;     ///< s
};
constexpr BenchSizes full_sizes{6, 7, 3, 4, 3, 600};
constexpr BenchSizes quick_sizes{3, 3, 3, 3, 3, 12};

BenchSizes sizes_for(const BenchArguments& arguments) {
    BenchSizes sizes = arguments.quick ? quick_sizes : full_sizes;
    if (arguments.levels > 0)
        for (int* levels : {&sizes.levels, &sizes.levels_of_paper, &sizes.levels_of_table_8, &sizes.levels_of_figures})
            *levels = std::min(*levels, arguments.levels);
    if (arguments.levels > 0)
        sizes.levels_of_some = arguments.levels;
    if (arguments.time_limit > 0)
        sizes.time_limit = arguments.time_limit;
    return sizes;
}

/// Series of one quantity over unknowns, of both methods in all scenarios.
template <typename Quantity>
LogPanel panel_of(const RmtrResults& results, const std::string& title, const Quantity& quantity) {
    constexpr std::array colors{"#1f77b4", "#d62728", "#2ca02c", "#9467bd"};
    LogPanel panel{title, "unknowns", {}};
    for (std::size_t s = 0; s < scenarios.size(); ++s)
        for (const Way way : {Way::rmtr, Way::trust_region}) {
            LogSeries series{fmt::format("{}, {}", scenario_name(scenarios[s]), way_name(way)),
                             colors[s],
                             way == Way::trust_region,
                             {}};
            for (int levels = 2; levels <= results.most_levels(); ++levels)
                if (const SurfaceRun* run = results.find(scenarios[s], way, levels); run && run->converged)
                    series.points.push_back({static_cast<double>(run->unknowns), quantity(*run)});
            panel.series.push_back(std::move(series));
        }
    return panel;
}

/// Measures, and writes what there is after every contestant, so that an interrupted bench leaves what it had.
class RmtrBench {
public:
    RmtrBench(const BenchArguments& arguments, Console& console)
        : arguments_(arguments), console_(console),
          sizes_(sizes_for(arguments)), rules_{sizes_.time_limit, arguments.threads} {
        for (const Scenario scenario : scenarios)
            if (arguments.scenario.empty() || arguments.scenario == scenario_name(scenario))
                scenarios_.push_back(scenario);
    }

    void run() {
        for (int levels = arguments_.first_levels; levels <= std::max(sizes_.levels, sizes_.levels_of_some); ++levels)
            compete(levels);
        measure_conditions();
        measure_largest_steps();
        save();
        console_.clear_bar();
        print_rmtr_tables(results_, rules_);
        if (rmtr_ratios(results_).empty())
            throw ExitStatus{ExitCode::failed};
    }

private:
    void compete(int levels) {
        for (const Scenario scenario : scenarios_) {
            const int most = scenario == Scenario::reentrant_corner ? sizes_.levels : sizes_.levels_of_some;
            if (levels > most)
                continue;
            compete(scenario, Way::trust_region, levels);
            if (levels >= 2)
                compete(scenario, Way::rmtr, levels);
            if (scenario == Scenario::trampoline && levels >= 2 && levels <= sizes_.levels_of_paper)
                compete(scenario, Way::paper, levels);
            if (levels == sizes_.levels_of_table_8)
                compete(scenario, Way::least_squares, levels);
        }
    }

    void compete(Scenario scenario, Way way, int levels) {
        const SurfaceRun run = run_contestant(scenario, way, levels, rules_, console_);
        expect_uninterrupted();
        console_.on_message(fmt::format("{}, {} unknowns, {}: {:.2f} s; {}", scenario_name(scenario), run.unknowns,
                                        way_name(way), run.seconds, run.message));
        results_.runs.push_back(run);
        save();
    }

    void measure_conditions() {
        constexpr int most_levels = 6;
        for (const bool boundary_variables : {false, true}) {
            for (int levels = arguments_.first_levels; levels <= std::min(sizes_.levels, most_levels); ++levels)
                measure_condition(levels, boundary_variables, 0);
            for (double penalty = 1e2; penalty < 2e10 && has_figures(); penalty *= 10)
                measure_condition(sizes_.levels_of_figures, boundary_variables, penalty);
        }
    }

    void measure_condition(int levels, bool boundary_variables, double penalty) {
        const Condition condition = trampoline_condition(levels, boundary_variables, penalty, rules_, console_);
        expect_uninterrupted();
        results_.conditions.push_back({boundary_variables, penalty, condition});
    }

    bool has_figures() const { return arguments_.first_levels <= sizes_.levels_of_figures; }

    void measure_largest_steps() {
        if (!has_figures())
            return;
        for (const Scenario scenario : scenarios_)
            for (const Way way : ways_of_figure_10) {
                const LargestStep step = find_largest_step(scenario, way, sizes_.levels_of_figures, rules_, console_);
                expect_uninterrupted();
                console_.on_message(fmt::format("{}, {}: largest time step {:g} s{}", scenario_name(scenario),
                                                way_name(way), step.time_step, step.timed_out ? ", out of time" : ""));
                results_.largest_steps.push_back(step);
            }
    }

    void expect_uninterrupted() const {
        if (console_.cancelled())
            throw ExitStatus{ExitCode::interrupted};
    }

    void save() const {
        if (!arguments_.json.empty()) {
            nlohmann::ordered_json json = {{"benchmark", arguments_.name},
                                           {"quick", arguments_.quick},
                                           {"threads", arguments_.threads},
                                           {"time_limit", rules_.time_limit},
                                           {"ratios", rmtr_ratios(results_)}};
            json.update(rmtr_results_json(results_));
            write_file_atomically(arguments_.json, json.dump(2) + "\n");
        }
        if (!arguments_.plot.empty())
            write_file_atomically(arguments_.plot,
                                  log_plot({panel_of(results_, "seconds of processor time",
                                                     [](const SurfaceRun& run) { return run.seconds; }),
                                            panel_of(results_, "peak memory, MB", [](const SurfaceRun& run) {
                                                return static_cast<double>(run.peak_memory) / 1e6;
                                            })}));
    }

    const BenchArguments& arguments_;
    Console& console_;
    BenchSizes sizes_;
    ContestRules rules_;
    std::vector<Scenario> scenarios_;
    RmtrResults results_;
};

} // namespace

void run_rmtr_bench(const BenchArguments& arguments) {
    Console console(progress_style("auto", false));
    const InterruptGuard guard(console);
    RmtrBench(arguments, console).run();
}

} // namespace plisse
