#include "log_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace plisse {

namespace {

constexpr double panel_width = 440, panel_height = 330, left = 56, right = 12, top = 30, bottom = 44;
constexpr double legend_row = 18;

/// From the smallest value to the largest, and where they lie between two ends of the picture.
struct LogAxis {
    double begin, end; ///< px
    double least = std::numeric_limits<double>::infinity(), most = 0;

    void include(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
    bool is_empty() const { return most == 0; }
    double place(double value) const {
        constexpr double margin = 0.05; // at either end, of the length between
        const double share = most > least ? std::log(value / least) / std::log(most / least) : 0.5;
        return begin + (margin + (1 - 2 * margin) * share) * (end - begin);
    }
    bool holds(double value) const {
        const double at = place(value);
        return std::min(begin, end) <= at && at <= std::max(begin, end);
    }
    /// Decades, and where these are few twice and five times them.
    std::vector<double> ticks() const {
        constexpr double few = 2.5; // decades
        std::vector<double> values;
        for (double decade = std::floor(std::log10(least)) - 1; decade <= std::log10(most) + 1; ++decade)
            for (const double factor : {1.0, 2.0, 5.0}) {
                const double value = factor * std::pow(10, decade);
                if (holds(value) && (factor == 1 || std::log10(most / least) < few))
                    values.push_back(value);
            }
        return values;
    }
};

std::string text(double x, double y, const char* anchor, const std::string& words) {
    return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, words);
}

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
    return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", x1, y1, x2, y2, style);
}

std::string stroke_of(const LogSeries& series) {
    return fmt::format("stroke=\"{}\" stroke-width=\"1.6\"{}", series.color,
                       series.dashed ? " stroke-dasharray=\"5 3\"" : "");
}

std::string drawn(const LogSeries& series, const LogAxis& x, const LogAxis& y) {
    std::string places, marks;
    for (const auto& [px, py] : series.points) {
        places += fmt::format("{:.1f},{:.1f} ", x.place(px), y.place(py));
        marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\" fill=\"{}\"/>\n", x.place(px), y.place(py),
                             series.color);
    }
    return fmt::format("<polyline points=\"{}\" fill=\"none\" {}/>\n", places, stroke_of(series)) + marks;
}

std::string panel_drawn(const LogPanel& panel, double x0) {
    LogAxis x{x0 + left, x0 + panel_width - right}, y{panel_height - bottom, top};
    for (const LogSeries& series : panel.series)
        for (const auto& [px, py] : series.points) {
            x.include(px);
            y.include(py);
        }
    std::string svg = text(x0 + left, top - 10, "start", panel.title);
    if (x.is_empty())
        return svg;
    const std::string grid = "stroke=\"#ddd\"";
    for (const double value : x.ticks()) {
        const double place = x.place(value);
        svg +=
            line(place, y.begin, place, y.end, grid) + text(place, y.begin + 16, "middle", fmt::format("{:g}", value));
    }
    for (const double value : y.ticks()) {
        const double place = y.place(value);
        svg +=
            line(x.begin, place, x.end, place, grid) + text(x.begin - 6, place + 4, "end", fmt::format("{:g}", value));
    }
    svg += text(0.5 * (x.begin + x.end), panel_height - 8, "middle", panel.x_name);
    for (const LogSeries& series : panel.series)
        svg += drawn(series, x, y);
    return svg;
}

/// Two columns below the panels.
std::string legend(const std::vector<LogSeries>& all, double width) {
    std::string svg;
    for (std::size_t s = 0; s < all.size(); ++s) {
        const double x = left + (s % 2 == 0 ? 0 : width / 2);
        const double y = panel_height + legend_row * (static_cast<double>(s / 2) + 0.5);
        svg += line(x, y, x + 36, y, stroke_of(all[s])) + text(x + 44, y + 4, "start", all[s].name);
    }
    return svg;
}

} // namespace

std::string log_plot(const std::vector<LogPanel>& panels) {
    const std::vector<LogSeries> none;
    const std::vector<LogSeries>& named = panels.empty() ? none : panels.front().series;
    const double width = panel_width * static_cast<double>(panels.size());
    const double height = panel_height + legend_row * (std::ceil(static_cast<double>(named.size()) / 2) + 0.5);
    std::string svg = fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
                                  "width=\"{0:.0f}\" height=\"{1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
                                  "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
                                  width, height);
    for (std::size_t p = 0; p < panels.size(); ++p)
        svg += panel_drawn(panels[p], panel_width * static_cast<double>(p));
    return svg + legend(named, width) + "</svg>\n";
}

} // namespace plisse
