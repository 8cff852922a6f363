#include "bench_command.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <plisse/base/error.h>
#include <plisse/scene/json_cursor.h>

#include "bench_arguments.h"
#include "bench_progressive.h"
#include "bench_rmtr.h"
#include "bench_surfaces.h"

namespace plisse {

namespace {

struct Bench {
    const char* name;
    void (*run)(const BenchArguments&);
};

constexpr std::array benches{Bench{"can", run_progressive_bench}, Bench{"twist", run_progressive_bench},
                             Bench{"rmtr", run_rmtr_bench}};

std::vector<std::string> bench_names() {
    std::vector<std::string> names;
    for (const Bench& bench : benches)
        names.emplace_back(bench.name);
    return names;
}

void run_bench(const BenchArguments& arguments) {
    const auto* bench =
        std::find_if(benches.begin(), benches.end(), [&](const Bench& b) { return b.name == arguments.name; });
    if (bench == benches.end())
        throw InputError("bench", "there is no benchmark \"" + arguments.name + "\"",
                         "the nearest is `plisse bench " + nearest_name(arguments.name, bench_names()) + "`");
    const bool asks_for_rmtr = !arguments.plot.empty() || !arguments.scenario.empty() || arguments.first_levels > 1 ||
                               arguments.levels > 0 || arguments.time_limit > 0;
    if (asks_for_rmtr && bench->run != run_rmtr_bench)
        throw InputError("bench",
                         "--plot, --scenario, --first-levels, --levels and --time-limit are of the benchmark rmtr",
                         "leave them out for \"" + arguments.name + "\"");
    if (arguments.levels > 0 && arguments.first_levels > arguments.levels)
        throw InputError("bench", "--first-levels is above --levels", "give no more than --levels");
    bench->run(arguments);
}

} // namespace

void add_bench_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("bench", "Runs a benchmark: methods side by side");
    auto arguments = std::make_shared<BenchArguments>();
    command->add_option("NAME", arguments->name, fmt::format("{}", fmt::join(bench_names(), ", ")))->required();
    command->add_flag("--quick", arguments->quick, "smaller meshes, less than three minutes");
    command->add_option("--json", arguments->json, "writes the ratios to this file");
    command->add_option("--plot", arguments->plot, "rmtr: writes time and memory over size to this file, as SVG");
    std::vector<std::string> scenario_names;
    for (const Scenario scenario : scenarios)
        scenario_names.emplace_back(scenario_name(scenario));
    command->add_option("--scenario", arguments->scenario, "rmtr: runs this one only")
        ->check(CLI::IsMember(scenario_names));
    command->add_option("--first-levels", arguments->first_levels, "rmtr: the fewest levels")->check(CLI::Range(1, 7));
    command->add_option("--levels", arguments->levels, "rmtr: the most levels, instead of 7, or 3 if quick")
        ->check(CLI::Range(2, 7));
    command->add_option("--time-limit", arguments->time_limit, "rmtr: seconds of a contestant, instead of 600, or 15")
        ->check(CLI::PositiveNumber);
    command->add_option("--threads", arguments->threads, "threads; 0: one a processor")->check(CLI::Range(0, 1024));
    command->callback([arguments] { run_bench(*arguments); });
}

} // namespace plisse
