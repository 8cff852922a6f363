#include "rmtr_results.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

std::string key_of(const SurfaceRun& run, const char* what) {
    std::string name = scenario_name(run.scenario);
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
    return fmt::format("{}_{}_{}", name, run.unknowns, what);
}

} // namespace

const SurfaceRun* RmtrResults::find(Scenario scenario, Way way, int levels) const {
    const auto run = std::find_if(runs.begin(), runs.end(), [&](const SurfaceRun& r) {
        return r.scenario == scenario && r.way == way && r.levels == levels;
    });
    return run == runs.end() ? nullptr : &*run;
}

bool RmtrResults::has(Scenario scenario) const {
    return std::any_of(runs.begin(), runs.end(), [&](const SurfaceRun& run) { return run.scenario == scenario; });
}

int RmtrResults::most_levels() const {
    int most = 0;
    for (const SurfaceRun& run : runs)
        most = std::max(most, run.levels);
    return most;
}

Json rmtr_ratios(const RmtrResults& results) {
    Json ratios = Json::object();
    for (const SurfaceRun& rmtr : results.runs) {
        const SurfaceRun* single = results.find(rmtr.scenario, Way::trust_region, rmtr.levels);
        if (rmtr.way != Way::rmtr || !rmtr.converged || !single || !single->converged)
            continue;
        ratios[key_of(rmtr, "seconds")] = single->seconds / rmtr.seconds;
        ratios[key_of(rmtr, "memory")] =
            static_cast<double>(single->peak_memory) / static_cast<double>(rmtr.peak_memory);
        ratios[key_of(rmtr, "assembly_units")] = single->assembly_units / rmtr.assembly_units;
        ratios[key_of(rmtr, "quadratic_units")] = single->quadratic_units / rmtr.quadratic_units;
        ratios[key_of(rmtr, "product_units")] = single->product_units / rmtr.product_units;
    }
    return ratios;
}

Json rmtr_results_json(const RmtrResults& results) {
    Json runs = Json::array(), conditions = Json::array(), steps = Json::array();
    for (const SurfaceRun& run : results.runs)
        runs.push_back(run_json(run));
    for (const RmtrResults::ConditionOf& of : results.conditions)
        conditions.push_back({{"unknowns", of.condition.unknowns},
                              {"boundary_variables", of.boundary_variables},
                              {"penalty", of.penalty > 0 ? Json(of.penalty) : Json(nullptr)},
                              {"condition", std::isfinite(of.condition.number) ? Json(of.condition.number) : Json()}});
    for (const LargestStep& step : results.largest_steps)
        steps.push_back({{"scenario", scenario_name(step.scenario)},
                         {"way", way_name(step.way)},
                         {"unknowns", step.unknowns},
                         {"time_step", step.time_step > 0 ? Json(step.time_step) : Json()},
                         {"timed_out", step.timed_out}});
    return {{"runs", runs}, {"conditions", conditions}, {"largest_steps", steps}};
}

} // namespace plisse
