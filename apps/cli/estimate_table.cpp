#include "estimate_table.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

std::string in_words(const FoldScale& scale) {
    if (scale.cause != FoldCause::shape)
        return fmt::format("{}, with a radius of about {:.3g} mm", describe(scale.cause), 1e3 * scale.radius);
    return std::isfinite(scale.length) ? fmt::format("no folds are expected; the shape at rest has a radius of about "
                                                     "{:.3g} mm",
                                                     1e3 * scale.length)
                                       : "no folds are expected";
}

std::string advice(const FoldEstimates& estimates) {
    if (estimates.enough_vertices < estimates.body_vertices)
        return fmt::format("recommended: coarsest_vertices {} or more\n", estimates.enough_vertices);
    return "the folds may be too fine even for the finest level\n";
}

} // namespace

FoldEstimates estimate_folds(const Hierarchy& hierarchy, std::vector<std::string> names,
                             std::vector<std::vector<FoldScale>> scales) {
    std::vector<FoldScale> governing;
    for (const std::vector<FoldScale>& of_body : scales)
        governing.push_back(of_body.front());
    FoldEstimates estimates{std::move(names), std::move(scales), {}, 0, 0};
    for (const HierarchyLevel& level : hierarchy.levels)
        estimates.levels.push_back(estimate_level(level, governing));
    estimates.enough_vertices = enough_vertices(hierarchy.finest(), governing);
    const std::vector<int>& part = hierarchy.finest().part;
    estimates.body_vertices = static_cast<int>(std::count_if(
        part.begin(), part.end(), [&](int number) { return number < static_cast<int>(governing.size()); }));
    return estimates;
}

std::string estimate_table(const FoldEstimates& estimates) {
    std::string text = "\nhow coarse is sound, an estimate:\n";
    for (std::size_t b = 0; b < estimates.names.size(); ++b)
        text += fmt::format("{}: {}\n", estimates.names[b], in_words(estimates.scales[b].front()));
    text += fmt::format("{:>5} {:>9} {:>9} {:>15} {:>9}  {}\n", "level", "edge mm", "95 %", "turn, degrees", "of limit",
                        "estimate");
    for (std::size_t l = 0; l < estimates.levels.size(); ++l) {
        const LevelEstimate& e = estimates.levels[l];
        text +=
            fmt::format("{:>5} {:>9.3g} {:>9.3g} {:>15.0f} {:>9.2f}  {}\n", l, 1e3 * e.median_edge, 1e3 * e.long_edge,
                        e.turn * 180 / std::numbers::pi, e.turn / most_turn, verdict_name(e.verdict));
    }
    return text + advice(estimates);
}

void add_estimates(const FoldEstimates& estimates, Json& json) {
    for (std::size_t l = 0; l < estimates.levels.size(); ++l) {
        const LevelEstimate& e = estimates.levels[l];
        json["levels"][l]["edge"] = {{"median", e.median_edge}, {"p95", e.long_edge}};
        json["levels"][l]["estimate"] = {{"verdict", verdict_name(e.verdict)},
                                         {"turn", finite_or_null(e.turn)},
                                         {"of_limit", finite_or_null(e.turn / most_turn)},
                                         {"body", estimates.names[static_cast<std::size_t>(e.part)]},
                                         {"cause", describe(e.governing.cause)}};
    }
    Json& estimate = json["estimate"];
    estimate = {{"recommended_coarsest_vertices", estimates.enough_vertices}, {"bodies", Json::array()}};
    for (std::size_t b = 0; b < estimates.names.size(); ++b) {
        Json folds = Json::array();
        for (const FoldScale& scale : estimates.scales[b])
            folds.push_back({{"cause", describe(scale.cause)},
                             {"radius", finite_or_null(scale.radius)},
                             {"length", finite_or_null(scale.length)}});
        estimate["bodies"].push_back({{"name", estimates.names[b]}, {"folds", folds}});
    }
}

} // namespace plisse
