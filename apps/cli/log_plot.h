#pragma once

#include <array>
#include <string>
#include <vector>

namespace plisse {

/// A line through points (x, y), x and y > 0.
struct LogSeries {
    std::string name;
    std::string color; ///< as SVG has it
    bool dashed = false;
    std::vector<std::array<double, 2>> points;
};

/// Axes, both logarithmic, with what is drawn between them.
struct LogPanel {
    std::string title, x_name;
    std::vector<LogSeries> series;
};

/// An SVG picture of panels side by side, with one legend for the first panel's series.
std::string log_plot(const std::vector<LogPanel>& panels);

} // namespace plisse
