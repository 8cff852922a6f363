#include "console.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <unistd.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace plisse {

namespace {

std::string clock_time(double seconds) {
    if (!std::isfinite(seconds))
        return "?";
    const long whole = std::lround(seconds);
    if (whole >= 3600)
        return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string gap_text(double gap) {
    return std::isfinite(gap) ? fmt::format("{:.3g} mm", 1e3 * gap) : "none";
}

std::string place_in_run(const Progress& p) {
    return fmt::format("level {} of {} {:<7} t {:.4g}/{:.4g} s step {} iteration {} gap {}", p.level, p.level_count - 1,
                       p.phase, p.time, p.duration, p.step, p.iteration, gap_text(p.gap));
}

nlohmann::ordered_json number_or_null(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

} // namespace

ProgressStyle progress_style(const std::string& name, bool quiet) {
    if (quiet)
        return ProgressStyle::quiet;
    if (name == "json")
        return ProgressStyle::json;
    return name == "auto" && isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::plain;
}

void Console::on_progress(const Progress& progress) {
    if (first_fraction_ < 0)
        first_fraction_ = progress.fraction;
    if (style_ == ProgressStyle::quiet || !is_due(progress))
        return;
    if (style_ == ProgressStyle::bar)
        show_bar(progress);
    else if (style_ == ProgressStyle::plain)
        show_line(progress);
    else
        show_json(progress);
}

bool Console::is_due(const Progress& progress) {
    const double interval = style_ == ProgressStyle::plain ? 5.0 : 0.1;
    const bool new_part = progress.level != shown_level_ || progress.phase != shown_phase_;
    if (watch_.seconds() - shown_at_ < interval && !new_part)
        return false;
    shown_at_ = watch_.seconds();
    shown_level_ = progress.level;
    shown_phase_ = progress.phase;
    return true;
}

double Console::seconds_left(double fraction) const {
    const double done = fraction - first_fraction_;
    return done > 1e-3 ? watch_.seconds() * (1 - fraction) / done : std::numeric_limits<double>::infinity();
}

void Console::show_bar(const Progress& progress) {
    constexpr int width = 24;
    const int filled = std::clamp(static_cast<int>(progress.fraction * width), 0, width);
    fmt::print(stderr, "\r[{:#<{}}{:.<{}}] {:3.0f} % {} left {}\x1b[K", "", filled, "", width - filled,
               100 * progress.fraction, place_in_run(progress), clock_time(seconds_left(progress.fraction)));
    std::fflush(stderr);
    bar_on_screen_ = true;
}

void Console::show_line(const Progress& progress) const {
    fmt::print(stderr, "{:3.0f} % {} left {}\n", 100 * progress.fraction, place_in_run(progress),
               clock_time(seconds_left(progress.fraction)));
}

void Console::show_json(const Progress& p) const {
    const nlohmann::ordered_json json = {{"level", p.level},
                                         {"levels", p.level_count},
                                         {"phase", p.phase},
                                         {"t", p.time},
                                         {"duration", p.duration},
                                         {"step", p.step},
                                         {"iteration", p.iteration},
                                         {"step_norm", number_or_null(p.step_norm)},
                                         {"gap", number_or_null(p.gap)},
                                         {"fraction", p.fraction},
                                         {"seconds", watch_.seconds()},
                                         {"seconds_left", number_or_null(seconds_left(p.fraction))}};
    fmt::print("{}\n", json.dump());
    std::fflush(stdout);
}

void Console::on_message(const std::string& message) {
    if (style_ == ProgressStyle::json) {
        fmt::print("{}\n", nlohmann::ordered_json{{"message", message}}.dump());
        return;
    }
    clear_bar();
    fmt::print(stderr, "plisse: {}\n", message);
}

void Console::clear_bar() {
    if (bar_on_screen_)
        fmt::print(stderr, "\r\x1b[K");
    bar_on_screen_ = false;
}

} // namespace plisse
