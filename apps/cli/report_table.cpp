#include "report_table.h"

#include <cmath>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/scene/json_document.h>

namespace plisse {

namespace {

std::string millimetres(double metres) {
    return std::isfinite(metres) ? fmt::format("{:.4g}", 1e3 * metres) : "-";
}

std::string ratio(double a, double b) {
    return a > 0 && b > 0 ? fmt::format("{:.2f}", b / a) : "-";
}

std::string headline(const StoredReport& stored) {
    const RunReport& r = stored.report;
    std::string text =
        fmt::format("{} ({}): {}, {:.2f} s, {} thread{}, {:.0f} MB, {} intersecting pair{}\n", r.name, r.method,
                    run_status_name(r.status), r.wall_seconds, stored.process.threads,
                    stored.process.threads == 1 ? "" : "s", static_cast<double>(stored.process.peak_memory_bytes) / 1e6,
                    r.intersecting_pairs, r.intersecting_pairs == 1 ? "" : "s");
    return r.message.empty() ? text : text + r.message + "\n";
}

/// Mean and largest.
std::string distance_in_words(const PreviewDistance& distance) {
    return std::isfinite(distance.mean) ? fmt::format("{:.2g} / {:.2g}", 1e3 * distance.mean, 1e3 * distance.largest)
                                        : "-";
}

std::string level_rows(const RunReport& report) {
    std::string text =
        fmt::format("\n{:>5} {:>9} {:>9} {:>6} {:>10} {:>11} {:>8} {:>10} {:>9} {:>16}\n", "level", "vertices", "faces",
                    "steps", "iterations", "equilibrium", "gap mm", "stretch", "residual", "to final, mm");
    for (const LevelReport& l : report.levels)
        text += fmt::format("{:>5} {:>9} {:>9} {:>6} {:>10} {:>11} {:>8} {:>10.4g} {:>9.2g} {:>16}\n", l.level,
                            l.vertices, l.faces, l.steps, l.newton_iterations, l.equilibrium ? "yes" : "no",
                            millimetres(l.min_gap), l.max_stretch, l.residual, distance_in_words(l.to_final));
    return text;
}

double degrees(double radians) {
    return radians * 180 / std::numbers::pi;
}

/// Where each level was too coarse for the shape it took. One that is much too coarse may not fold at all and look
/// fine, so the estimate is told too.
std::string coarse_rows(const RunReport& report) {
    std::string text = "\n";
    for (const LevelReport& l : report.levels) {
        const TooCoarse& found = l.too_coarse;
        if (found.worst > 1)
            text += fmt::format("level {}: {:.2g} % of the area too coarse, worst near ({:.4g}, {:.4g}, {:.4g}): turns "
                                "of {:.0f} degrees over edges of {} mm",
                                l.level, 100 * found.share, found.place.x(), found.place.y(), found.place.z(),
                                degrees(found.turn), millimetres(found.edge));
        else
            text += fmt::format("level {}: fine enough for its shape, turns of up to {:.0f} degrees an edge", l.level,
                                degrees(found.turn));
        text += fmt::format("; estimate: {} ({:.0f} degrees)\n", verdict_name(verdict_on(l.estimated_turn)),
                            degrees(l.estimated_turn));
    }
    return text;
}

std::string second_rows(const RunReport& report) {
    std::string text = fmt::format("\n{:>5} {:>9}", "level", "seconds");
    for (int phase = 0; phase < phase_count; ++phase)
        text += fmt::format(" {:>12}", phase_name(static_cast<Phase>(phase)));
    text += "\n";
    for (const LevelReport& l : report.levels) {
        text += fmt::format("{:>5} {:>9.2f}", l.level, l.total_seconds);
        for (double seconds : l.seconds.seconds)
            text += fmt::format(" {:>12.2f}", seconds);
        text += "\n";
    }
    return text;
}

std::string refinement_rows(const RunReport& report) {
    if (report.refinements.empty())
        return "";
    std::string text = fmt::format("\n{:>7} {:>10} {:>7} {:>9} {:>8} {:>8} {:>9} {:>8} {:>8}\n", "refine", "expansions",
                                   "batches", "first try", "sampled", "relaxed", "deferred", "gap mm", "seconds");
    for (const RefinementReport& r : report.refinements)
        text += fmt::format("{:>7} {:>10} {:>7} {:>9} {:>8} {:>8} {:>9} {:>8} {:>8.2f}\n",
                            fmt::format("{} to {}", r.from, r.to), r.expansions, r.colors, r.first_try, r.sampled,
                            r.relaxed, r.deferred, millimetres(r.min_gap), r.total_seconds);
    return text;
}

std::string ranges_in_words(const Lag& lag) {
    constexpr std::size_t most = 8;
    std::vector<std::string> ranges;
    for (const auto& [first, last] : lag.ranges)
        ranges.push_back(first == last ? fmt::format("{}", first) : fmt::format("{}-{}", first, last));
    if (ranges.size() > most) {
        ranges.resize(most);
        ranges.push_back("...");
    }
    return fmt::format("{}", fmt::join(ranges, ", "));
}

/// Level by level: how well a preview foretells what a handle feels.
std::string reaction_rows(const RunReport& report) {
    std::string text;
    for (const LevelReport& level : report.levels)
        for (const Reaction& r : level.reactions)
            text += fmt::format("level {} reaction of {}: force ({:.4g}, {:.4g}, {:.4g}) N, torque ({:.4g}, {:.4g}, "
                                "{:.4g}) N m\n",
                                level.level, r.name, r.force.x(), r.force.y(), r.force.z(), r.torque.x(), r.torque.y(),
                                r.torque.z());
    return text;
}

std::string script_rows(const RunReport& report) {
    std::string text = reaction_rows(report);
    for (const Lag& lag : report.lagging)
        text += fmt::format("{} is short of its target by up to {} mm: {} vertices, {}\n", lag.name,
                            millimetres(lag.distance), lag.vertices, ranges_in_words(lag));
    return text.empty() ? text : "\n" + text;
}

std::string comparison_row(const std::string& name, double a, double b, const char* format) {
    return fmt::format("{:<28} {:>12} {:>12} {:>8}\n", name, fmt::format(fmt::runtime(format), a),
                       fmt::format(fmt::runtime(format), b), ratio(a, b));
}

} // namespace

StoredReport read_report(const std::filesystem::path& run_folder) {
    const std::filesystem::path file = run_folder / "report.json";
    const std::string bytes = read_bytes(file);
    try {
        const auto json = nlohmann::ordered_json::parse(bytes);
        return {report_from_json(json),
                {json.at("plisse").get<std::string>(), json.at("threads").get<int>(),
                 json.at("peak_memory_bytes").get<std::uint64_t>()}};
    } catch (const nlohmann::ordered_json::exception&) {
        throw InputError(file.string(), "this is not the report of a run", "give the folder of a run");
    }
}

std::string report_table(const StoredReport& stored) {
    const RunReport& report = stored.report;
    return headline(stored) + level_rows(report) + coarse_rows(report) + second_rows(report) + refinement_rows(report) +
           script_rows(report);
}

std::string comparison_table(const StoredReport& a, const std::string& name_a, const StoredReport& b,
                             const std::string& name_b) {
    std::string text = "a: " + name_a + ": " + headline(a) + "b: " + name_b + ": " + headline(b);
    text += fmt::format("\n{:<28} {:>12} {:>12} {:>8}\n", "", "a", "b", "b / a");
    text += comparison_row("wall seconds", a.report.wall_seconds, b.report.wall_seconds, "{:.2f}");
    text += comparison_row("memory, MB", static_cast<double>(a.process.peak_memory_bytes) / 1e6,
                           static_cast<double>(b.process.peak_memory_bytes) / 1e6, "{:.0f}");
    std::map<int, std::array<LevelReport, 2>> levels;
    for (const LevelReport& level : a.report.levels)
        levels[level.level][0] = level;
    for (const LevelReport& level : b.report.levels)
        levels[level.level][1] = level;
    for (const auto& [number, level] : levels) {
        const std::string prefix = fmt::format("level {} ", number);
        text += comparison_row(prefix + "vertices", level[0].vertices, level[1].vertices, "{:.0f}");
        text += comparison_row(prefix + "iterations", level[0].newton_iterations, level[1].newton_iterations, "{:.0f}");
        text += comparison_row(prefix + "seconds", level[0].total_seconds, level[1].total_seconds, "{:.2f}");
        for (int phase = 0; phase < phase_count; ++phase) {
            const auto p = static_cast<Phase>(phase);
            text += comparison_row(prefix + phase_name(p), level[0].seconds[p], level[1].seconds[p], "{:.2f}");
        }
    }
    return text;
}

} // namespace plisse
