#include <plisse/scene/report_json.h>

#include <cmath>
#include <limits>

#include <sys/resource.h>

#include <nlohmann/json.hpp>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

double number_or_infinity(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}

Json vector_json(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

Vec3 vector_from(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json reactions_json(const std::vector<Reaction>& reactions) {
    Json json = Json::object();
    for (const Reaction& reaction : reactions)
        json[reaction.name] = {{"force", vector_json(reaction.force)}, {"torque", vector_json(reaction.torque)}};
    return json;
}

std::vector<Reaction> reactions_from(const Json& json) {
    std::vector<Reaction> reactions;
    for (const auto& [name, reaction] : json.items())
        reactions.push_back({name, vector_from(reaction.at("force")), vector_from(reaction.at("torque"))});
    return reactions;
}

Json seconds_json(const PhaseTimes& times, double total) {
    Json json = {{"total", total}};
    for (int phase = 0; phase < phase_count; ++phase)
        json[phase_name(static_cast<Phase>(phase))] = times[static_cast<Phase>(phase)];
    return json;
}

PhaseTimes seconds_from(const Json& json) {
    PhaseTimes times;
    for (int phase = 0; phase < phase_count; ++phase)
        times[static_cast<Phase>(phase)] = json.at(phase_name(static_cast<Phase>(phase))).get<double>();
    return times;
}

/// With its totals in the work units of the finest level.
Json work_json(const std::vector<RmtrLevelWork>& work) {
    Json levels = Json::array();
    for (const RmtrLevelWork& level : work)
        levels.push_back({{"visits", level.visits},
                          {"accepted", level.accepted},
                          {"rejected", level.rejected},
                          {"corrections_accepted", level.corrections_accepted},
                          {"corrections_rejected", level.corrections_rejected},
                          {"assemblies", level.assemblies},
                          {"quadratic_solves", level.quadratic_solves},
                          {"quadratic_iterations", level.quadratic_iterations},
                          {"quadratic_products", level.quadratic_products},
                          {"evaluations", level.evaluations}});
    return {{"assembly_units", assembly_units(work)},
            {"quadratic_units", quadratic_units(work)},
            {"product_units", product_units(work)},
            {"levels", levels}};
}

std::vector<RmtrLevelWork> work_from(const Json& json) {
    std::vector<RmtrLevelWork> work;
    for (const Json& level : json.at("levels")) {
        RmtrLevelWork& of_level = work.emplace_back();
        level.at("visits").get_to(of_level.visits);
        level.at("accepted").get_to(of_level.accepted);
        level.at("rejected").get_to(of_level.rejected);
        level.at("corrections_accepted").get_to(of_level.corrections_accepted);
        level.at("corrections_rejected").get_to(of_level.corrections_rejected);
        level.at("assemblies").get_to(of_level.assemblies);
        level.at("quadratic_solves").get_to(of_level.quadratic_solves);
        level.at("quadratic_iterations").get_to(of_level.quadratic_iterations);
        level.at("quadratic_products").get_to(of_level.quadratic_products);
        level.at("evaluations").get_to(of_level.evaluations);
    }
    return work;
}

Json level_json(const LevelReport& level) {
    Json json = {{"level", level.level},
                 {"vertices", level.vertices},
                 {"faces", level.faces},
                 {"steps", level.steps},
                 {"newton_iterations", level.newton_iterations},
                 {"equilibrium", level.equilibrium},
                 {"min_gap", finite_or_null(level.min_gap)},
                 {"max_stretch", finite_or_null(level.max_stretch)},
                 {"residual", finite_or_null(level.residual)},
                 {"to_final",
                  {{"mean", finite_or_null(level.to_final.mean)}, {"largest", finite_or_null(level.to_final.largest)}}},
                 {"too_coarse",
                  {{"share", level.too_coarse.share},
                   {"worst", finite_or_null(level.too_coarse.worst)},
                   {"turn", finite_or_null(level.too_coarse.turn)},
                   {"edge", level.too_coarse.edge},
                   {"place", vector_json(level.too_coarse.place)},
                   {"estimated_turn", finite_or_null(level.estimated_turn)}}},
                 {"energy",
                  {{"elastic", level.energy.elastic},
                   {"strain_limit", level.energy.strain_limit},
                   {"contact", level.energy.contact},
                   {"friction", level.energy.friction},
                   {"gravity", level.energy.gravity},
                   {"loads", level.energy.loads}}},
                 {"reactions", reactions_json(level.reactions)},
                 {"seconds", seconds_json(level.seconds, level.total_seconds)}};
    if (!level.work.empty())
        json["work"] = work_json(level.work);
    return json;
}

LevelReport level_from(const Json& json) {
    LevelReport level;
    json.at("level").get_to(level.level);
    json.at("vertices").get_to(level.vertices);
    json.at("faces").get_to(level.faces);
    json.at("steps").get_to(level.steps);
    json.at("newton_iterations").get_to(level.newton_iterations);
    json.at("equilibrium").get_to(level.equilibrium);
    level.min_gap = number_or_infinity(json.at("min_gap"));
    level.max_stretch = number_or_infinity(json.at("max_stretch"));
    level.residual = number_or_infinity(json.at("residual"));
    level.to_final = {number_or_infinity(json.at("to_final").at("mean")),
                      number_or_infinity(json.at("to_final").at("largest"))};
    const Json& coarse = json.at("too_coarse");
    level.too_coarse = {coarse.at("share").get<double>(), number_or_infinity(coarse.at("worst")),
                        number_or_infinity(coarse.at("turn")), coarse.at("edge").get<double>(),
                        vector_from(coarse.at("place"))};
    level.estimated_turn = number_or_infinity(coarse.at("estimated_turn"));
    const Json& energy = json.at("energy");
    level.energy.elastic = number_or_infinity(energy.at("elastic"));
    level.energy.strain_limit = number_or_infinity(energy.at("strain_limit"));
    level.energy.contact = number_or_infinity(energy.at("contact"));
    level.energy.friction = number_or_infinity(energy.at("friction"));
    level.energy.gravity = number_or_infinity(energy.at("gravity"));
    level.energy.loads = number_or_infinity(energy.at("loads"));
    level.reactions = reactions_from(json.at("reactions"));
    level.seconds = seconds_from(json.at("seconds"));
    json.at("seconds").at("total").get_to(level.total_seconds);
    if (json.contains("work"))
        level.work = work_from(json.at("work"));
    return level;
}

Json refinement_json(const RefinementReport& refinement) {
    return {{"from", refinement.from},
            {"to", refinement.to},
            {"expansions", refinement.expansions},
            {"colors", refinement.colors},
            {"first_try", refinement.first_try},
            {"sampled", refinement.sampled},
            {"relaxed", refinement.relaxed},
            {"deferred", refinement.deferred},
            {"stopped", refinement.stopped},
            {"over_limit", refinement.over_limit},
            {"strain_limit_iterations", refinement.strain_limit_iterations},
            {"min_gap", finite_or_null(refinement.min_gap)},
            {"seconds", {{"total", refinement.total_seconds}}}};
}

RefinementReport refinement_from(const Json& json) {
    RefinementReport refinement;
    json.at("from").get_to(refinement.from);
    json.at("to").get_to(refinement.to);
    json.at("expansions").get_to(refinement.expansions);
    json.at("colors").get_to(refinement.colors);
    json.at("first_try").get_to(refinement.first_try);
    json.at("sampled").get_to(refinement.sampled);
    json.at("relaxed").get_to(refinement.relaxed);
    json.at("deferred").get_to(refinement.deferred);
    json.at("stopped").get_to(refinement.stopped);
    json.at("over_limit").get_to(refinement.over_limit);
    json.at("strain_limit_iterations").get_to(refinement.strain_limit_iterations);
    refinement.min_gap = number_or_infinity(json.at("min_gap"));
    json.at("seconds").at("total").get_to(refinement.total_seconds);
    return refinement;
}

RunStatus status_from(const std::string& name) {
    for (RunStatus status :
         {RunStatus::running, RunStatus::converged, RunStatus::not_converged, RunStatus::interrupted})
        if (name == run_status_name(status))
            return status;
    return RunStatus::failed;
}

} // namespace

std::uint64_t peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024; // the system counts in kibibytes
}

Json report_to_json(const RunReport& report, const ProcessFacts& process) {
    Json json = {{"plisse", process.version},
                 {"name", report.name},
                 {"method", report.method},
                 {"status", run_status_name(report.status)},
                 {"message", report.message},
                 {"wall_seconds", report.wall_seconds},
                 {"peak_memory_bytes", process.peak_memory_bytes},
                 {"threads", process.threads},
                 {"intersecting_pairs", report.intersecting_pairs},
                 {"levels", Json::array()},
                 {"refinements", Json::array()},
                 {"reactions", reactions_json(report.reactions)},
                 {"lagging", Json::array()}};
    for (const LevelReport& level : report.levels)
        json["levels"].push_back(level_json(level));
    for (const RefinementReport& refinement : report.refinements)
        json["refinements"].push_back(refinement_json(refinement));
    for (const Lag& lag : report.lagging)
        json["lagging"].push_back({{"name", lag.name},
                                   {"vertices", lag.vertices},
                                   {"distance", lag.distance},
                                   {"vertex_ranges", lag.ranges}});
    return json;
}

RunReport report_from_json(const Json& json) {
    RunReport report;
    json.at("name").get_to(report.name);
    json.at("method").get_to(report.method);
    json.at("message").get_to(report.message);
    report.status = status_from(json.at("status").get<std::string>());
    json.at("wall_seconds").get_to(report.wall_seconds);
    json.at("intersecting_pairs").get_to(report.intersecting_pairs);
    for (const Json& level : json.at("levels"))
        report.levels.push_back(level_from(level));
    for (const Json& refinement : json.at("refinements"))
        report.refinements.push_back(refinement_from(refinement));
    report.reactions = reactions_from(json.at("reactions"));
    for (const Json& lag : json.at("lagging"))
        report.lagging.push_back({lag.at("name").get<std::string>(), lag.at("vertices").get<int>(),
                                  number_or_infinity(lag.at("distance")),
                                  lag.value("vertex_ranges", std::vector<std::array<int, 2>>())});
    return report;
}

} // namespace plisse
