#include "rmtr_tables.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// The paper's numbers, by scenario. 0: it reports failure.
constexpr int not_in_paper = -1;
constexpr int paper_most_levels = 6;
using PaperCounts = std::array<std::array<int, paper_most_levels>, scenarios.size()>;
constexpr PaperCounts paper_table_3{{{1385, 29426, 34456, 0, 0, 0},
                                     {1976, 43475, 15444, 12792, 0, 0},
                                     {8293, 13965, 18873, 47536, 334463, 0},
                                     {7331, 53654, 175132, 0, 0, 0}}};
constexpr PaperCounts paper_table_4{{{0, 633, 150, 81, 88, 52},
                                     {0, 4671, 645, 707, 1636, 333},
                                     {0, 3188, 1508, 282, 124, 30},
                                     {0, 9732, 7653, 5718, 792, 423}}};
constexpr std::array<int, scenarios.size()> paper_table_8{84, 659, 277, 5691}; // least squares, 4 levels
constexpr int paper_table_8_levels = 4;

/// Tables 6 and 7, at 1,083 unknowns: assembly and quadratic problems.
struct PaperWork {
    int assembly, quadratic;
};
constexpr int paper_work_levels = 3;
constexpr std::array<PaperWork, scenarios.size()> paper_work_of_trust_region{
    {{30981, 34456}, {13858, 15444}, {16632, 18873}, {120089, 175132}}};
constexpr std::array<PaperWork, scenarios.size()> paper_work_of_rmtr{
    {{370, 370}, {1612, 1612}, {3788, 3788}, {19163, 19163}}};

std::size_t number_of(Scenario scenario) {
    return static_cast<std::size_t>(scenario);
}

/// Iterations of a run, with what cut it short.
std::string count_of(const SurfaceRun& run) {
    if (run.converged)
        return fmt::format("{}", run.iterations);
    if (run.timed_out)
        return fmt::format("{}, time", run.iterations);
    return run.seconds > 0 ? fmt::format("{}, cut", run.iterations) : "failed";
}

std::string with_paper(const std::string& ours, int paper) {
    if (paper == not_in_paper)
        return ours;
    return ours + (paper > 0 ? fmt::format(" ({})", paper) : " (-)");
}

int paper_count(const PaperCounts& table, Scenario scenario, int levels) {
    if (levels > paper_most_levels)
        return not_in_paper;
    return table[number_of(scenario)][at(levels - 1)];
}

/// Iterations by scenario and size.
void print_counts(const RmtrResults& results, Way way, int first_levels, const PaperCounts& paper) {
    fmt::print("{:<20}", "");
    for (int levels = first_levels; levels <= results.most_levels(); ++levels) {
        const int faces = 4 << (levels - 1);
        fmt::print(" {:>18}", 3 * (faces + 3) * (faces + 3));
    }
    fmt::print("\n");
    for (const Scenario scenario : scenarios) {
        if (!results.has(scenario))
            continue;
        fmt::print("{:<20}", scenario_name(scenario));
        for (int levels = first_levels; levels <= results.most_levels(); ++levels) {
            const SurfaceRun* run = results.find(scenario, way, levels);
            fmt::print(" {:>18}", run ? with_paper(count_of(*run), paper_count(paper, scenario, levels)) : "not run");
        }
        fmt::print("\n");
    }
}

void print_work_row(const SurfaceRun& run, const PaperWork* paper) {
    const double each = std::max(run.iterations, 1);
    const auto cell = [&](double units, int of_paper) { return with_paper(fmt::format("{:.0f}", units), of_paper); };
    fmt::print("{:<20} {:<20} {:>12} {:>18} {:>8.2f} {:>18} {:>8.2f} {:>12.0f} {:>8.2f}\n", scenario_name(run.scenario),
               way_name(run.way), count_of(run), cell(run.assembly_units, paper ? paper->assembly : not_in_paper),
               run.assembly_units / each, cell(run.quadratic_units, paper ? paper->quadratic : not_in_paper),
               run.quadratic_units / each, run.product_units, run.product_units / each);
}

void print_work(const RmtrResults& results) {
    const int levels = std::min(paper_work_levels, results.most_levels());
    const bool is_papers = levels == paper_work_levels;
    fmt::print(
        "\nTables 5 to 7: work of {} levels, in units of the finest; quadratic problems, and the products with H "
        "they took, in tens\n",
        levels);
    fmt::print("{:<20} {:<20} {:>12} {:>18} {:>8} {:>18} {:>8} {:>12} {:>8}\n", "", "", "iterations", "assembly",
               "each", "quadratic", "each", "products/10", "each");
    for (const Scenario scenario : scenarios)
        for (const Way way : {Way::trust_region, Way::rmtr, Way::paper}) {
            const SurfaceRun* run = results.find(scenario, way, levels);
            const PaperWork* paper = nullptr;
            if (is_papers && way == Way::trust_region)
                paper = &paper_work_of_trust_region[number_of(scenario)];
            if (is_papers && way == Way::paper)
                paper = &paper_work_of_rmtr[number_of(scenario)];
            if (run)
                print_work_row(*run, paper);
        }
}

void print_projections(const RmtrResults& results) {
    const auto run = std::find_if(results.runs.begin(), results.runs.end(),
                                  [](const SurfaceRun& r) { return r.way == Way::least_squares; });
    if (run == results.runs.end())
        return;
    const int levels = run->levels;
    fmt::print("\nTable 8: cycles by projection, {} unknowns\n{:<20} {:>18} {:>20}\n", run->unknowns, "",
               "least squares", "reverse subdivision");
    for (const Scenario scenario : scenarios) {
        const SurfaceRun* least_squares = results.find(scenario, Way::least_squares, levels);
        const SurfaceRun* reverse = results.find(scenario, Way::rmtr, levels);
        if (!least_squares || !reverse)
            continue;
        const bool is_papers = levels == paper_table_8_levels;
        const int paper = is_papers ? paper_table_8[number_of(scenario)] : not_in_paper;
        const int paper_reverse = is_papers ? paper_count(paper_table_4, scenario, levels) : not_in_paper;
        fmt::print("{:<20} {:>18} {:>20}\n", scenario_name(scenario), with_paper(count_of(*least_squares), paper),
                   with_paper(count_of(*reverse), paper_reverse));
    }
}

void print_conditions(const RmtrResults& results) {
    if (results.conditions.empty())
        return;
    fmt::print("\nFigure 9: condition number of a trampoline's Hessian at rest\n{:>10} {:>12} {:>16} {:>16}\n",
               "unknowns", "beta", "ghost points", "boundary curve");
    for (const RmtrResults::ConditionOf& ghosts : results.conditions) {
        if (ghosts.boundary_variables)
            continue;
        const auto curve = std::find_if(results.conditions.begin(), results.conditions.end(), [&](const auto& other) {
            return other.boundary_variables && other.penalty == ghosts.penalty &&
                   other.condition.unknowns == ghosts.condition.unknowns;
        });
        fmt::print("{:>10} {:>12} {:>16.2e} {:>16.2e}\n", ghosts.condition.unknowns,
                   ghosts.penalty > 0 ? fmt::format("{:.0e}", ghosts.penalty) : "h^-5", ghosts.condition.number,
                   curve == results.conditions.end() ? NAN : curve->condition.number);
    }
}

void print_largest_steps(const RmtrResults& results) {
    if (results.largest_steps.empty())
        return;
    fmt::print("\nFigure 10: the largest of the time steps 1, 0.5, 0.2, 0.1 ... {:g} s whose first step ends by (7.1), "
               "{} unknowns\n{:<20}",
               smallest_step, results.largest_steps.front().unknowns, "");
    for (const Way way : ways_of_figure_10)
        fmt::print(" {:>14}", way_name(way));
    fmt::print("\n");
    for (const Scenario scenario : scenarios) {
        if (!results.has(scenario))
            continue;
        fmt::print("{:<20}", scenario_name(scenario));
        for (const Way way : ways_of_figure_10)
            for (const LargestStep& step : results.largest_steps)
                if (step.scenario == scenario && step.way == way)
                    fmt::print(" {:>14}", step.time_step > 0 ? fmt::format("{:g}", step.time_step)
                                          : step.timed_out   ? "time"
                                                             : "none");
        fmt::print("\n");
    }
}

std::string megabytes(std::uint64_t bytes) {
    return fmt::format("{:.0f}", static_cast<double>(bytes) / 1e6);
}

void print_sizes(const RmtrResults& results) {
    fmt::print("\nTrust region beside rmtr: seconds of processor time for one step, and peak memory of its process in "
               "MB; ratios above 1 are in favour of rmtr\n");
    fmt::print("{:<20} {:>9} | {:>12} {:>9} {:>7} | {:>12} {:>9} {:>7} | {:>7} {:>7}\n", "", "unknowns", "iterations",
               "seconds", "MB", "cycles", "seconds", "MB", "time", "memory");
    for (const Scenario scenario : scenarios)
        for (int levels = 2; levels <= results.most_levels(); ++levels) {
            const SurfaceRun* single = results.find(scenario, Way::trust_region, levels);
            const SurfaceRun* rmtr = results.find(scenario, Way::rmtr, levels);
            if (!single || !rmtr)
                continue;
            const bool both = single->converged && rmtr->converged;
            const double memory = static_cast<double>(single->peak_memory) / static_cast<double>(rmtr->peak_memory);
            fmt::print("{:<20} {:>9} | {:>12} {:>9.2f} {:>7} | {:>12} {:>9.2f} {:>7} | {:>7} {:>7.2f}\n",
                       scenario_name(scenario), rmtr->unknowns, count_of(*single), single->seconds,
                       megabytes(single->peak_memory), count_of(*rmtr), rmtr->seconds, megabytes(rmtr->peak_memory),
                       both ? fmt::format("{:.2f}", single->seconds / rmtr->seconds) : "-", memory);
        }
}

/// From which size on rmtr is better in a quantity, at all larger sizes measured too.
template <typename Quantity>
std::string crossover(const RmtrResults& results, Scenario scenario, const Quantity& quantity) {
    int from = 0;
    for (int levels = results.most_levels(); levels >= 2; --levels) {
        const SurfaceRun* single = results.find(scenario, Way::trust_region, levels);
        const SurfaceRun* rmtr = results.find(scenario, Way::rmtr, levels);
        if (!single || !rmtr || !(single->converged || rmtr->converged))
            continue;
        const bool is_better = rmtr->converged && (!single->converged || quantity(*rmtr) < quantity(*single));
        if (!is_better)
            break;
        from = rmtr->unknowns;
    }
    return from > 0 ? fmt::format("from {} unknowns on", from) : "at no size measured";
}

void print_crossovers(const RmtrResults& results) {
    fmt::print("\n");
    for (const Scenario scenario : scenarios)
        if (results.has(scenario))
            fmt::print("{:<20} rmtr is faster {}, and takes less memory {}\n", scenario_name(scenario),
                       crossover(results, scenario, [](const SurfaceRun& run) { return run.seconds; }),
                       crossover(results, scenario, [](const SurfaceRun& run) { return run.peak_memory; }));
}

/// What did not converge, and why.
void print_failures(const RmtrResults& results) {
    for (const SurfaceRun& run : results.runs)
        if (!run.converged)
            fmt::print("not converged: {}, {}, {} levels: {}\n", scenario_name(run.scenario), way_name(run.way),
                       run.levels, run.message);
}

} // namespace

void print_rmtr_tables(const RmtrResults& results, const ContestRules& rules) {
    fmt::print("In brackets: the paper's (Kopanicakova, Krause and Tamstorf 2019), a dash where it failed. Contestants "
               "have {:g} s each.\n\n",
               rules.time_limit);
    fmt::print(
        "Table 3: iterations of the single-level trust region, by unknowns (fewer where the corner is cut out)\n");
    print_counts(results, Way::trust_region, 1, paper_table_3);
    fmt::print("\nTable 4: cycles of rmtr on the finest level, for 2 levels and more\n");
    print_counts(results, Way::rmtr, 2, paper_table_4);
    print_work(results);
    print_projections(results);
    print_conditions(results);
    print_largest_steps(results);
    print_sizes(results);
    print_crossovers(results);
    print_failures(results);
}

} // namespace plisse
