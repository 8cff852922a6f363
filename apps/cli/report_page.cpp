#include "report_page.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace plisse {

namespace {

constexpr std::array<const char*, phase_count> phase_colors = {"#4c78a8", "#e45756", "#f58518", "#72b7b2",
                                                               "#54a24b", "#b279a2", "#9d9d9d"};
constexpr std::array<const char*, 5> level_colors = {"#4c78a8", "#f58518", "#54a24b", "#e45756", "#b279a2"};

std::string escaped(const std::string& text) {
    std::string html;
    for (char c : text)
        html += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return html;
}

/// A horizontal bar a level, as long as its seconds, cut up by phase.
std::string phase_bars(const RunReport& report) {
    double longest = 1e-9;
    for (const LevelReport& level : report.levels)
        longest = std::max(longest, level.total_seconds);
    std::string svg = fmt::format("<svg width=\"900\" height=\"{}\">\n", 24 * report.levels.size() + 28);
    double y = 2;
    for (const LevelReport& level : report.levels) {
        svg += fmt::format("<text x=\"0\" y=\"{}\">level {}</text>\n", y + 14, level.level);
        double x = 70;
        for (std::size_t phase = 0; phase < phase_colors.size(); ++phase) {
            const double width = 700 * level.seconds.seconds[phase] / longest;
            svg += fmt::format("<rect x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"18\" fill=\"{}\"/>\n", x, y,
                               width, phase_colors[phase]);
            x += width;
        }
        svg += fmt::format("<text x=\"{:.2f}\" y=\"{}\">{:.2f} s</text>\n", x + 6, y + 14, level.total_seconds);
        y += 24;
    }
    for (std::size_t phase = 0; phase < phase_colors.size(); ++phase)
        svg += fmt::format("<rect x=\"{0}\" y=\"{1}\" width=\"12\" height=\"12\" fill=\"{2}\"/><text x=\"{3}\" "
                           "y=\"{4}\">{5}</text>\n",
                           70 + 115 * phase, y + 4, phase_colors[phase], 86 + 115 * phase, y + 15,
                           phase_name(static_cast<Phase>(phase)));
    return svg + "</svg>\n";
}

/// One dot an iteration, its height the decimal logarithm of the step norm, its colour the level.
std::string iteration_chart(const std::vector<LoggedIteration>& log) {
    constexpr double width = 860, height = 240, highest = 2, lowest = -8;
    std::string svg = fmt::format("<svg width=\"900\" height=\"{}\">\n", height + 10);
    for (double power = lowest; power <= highest; power += 2) {
        const double y = height * (highest - power) / (highest - lowest);
        svg += fmt::format("<line x1=\"40\" x2=\"900\" y1=\"{0:.1f}\" y2=\"{0:.1f}\" stroke=\"#ddd\"/><text x=\"0\" "
                           "y=\"{1:.1f}\">1e{2}</text>\n",
                           y, y + 4, power);
    }
    for (std::size_t i = 0; i < log.size(); ++i) {
        const double power = std::clamp(std::log10(std::max(log[i].step_norm, 1e-300)), lowest, highest);
        svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.5\" fill=\"{}\"/>\n",
                           40 + width * static_cast<double>(i) / static_cast<double>(log.size()),
                           height * (highest - power) / (highest - lowest),
                           level_colors[static_cast<std::size_t>(log[i].level) % level_colors.size()]);
    }
    return svg + "</svg>\n";
}

} // namespace

std::vector<LoggedIteration> read_log(const std::filesystem::path& run_folder) {
    std::vector<LoggedIteration> log;
    std::ifstream lines(run_folder / "log.jsonl");
    for (std::string line; std::getline(lines, line);) {
        const auto json = nlohmann::json::parse(line, nullptr, false); // the last line of a killed run may be cut off
        if (json.is_object() && json.contains("level") && json.contains("step_norm") && json["step_norm"].is_number())
            log.push_back({json["level"].get<int>(), json["step_norm"].get<double>()});
    }
    return log;
}

std::string report_page(const StoredReport& stored, const std::vector<LoggedIteration>& log) {
    const std::string name = escaped(stored.report.name);
    return fmt::format("<!doctype html>\n<html><head><meta charset=\"utf-8\"><title>{0}</title>\n"
                       "<style>body{{font:14px sans-serif;margin:2em;max-width:60em}}svg text{{font-size:12px}}"
                       "pre{{overflow-x:auto}}</style></head>\n<body><h1>{0}</h1>\n<pre>{1}</pre>\n"
                       "<h2>Seconds by phase</h2>\n{2}<h2>Newton step norm, m/s, over iterations</h2>\n{3}"
                       "</body></html>\n",
                       name, escaped(report_table(stored)), phase_bars(stored.report), iteration_chart(log));
}

} // namespace plisse
