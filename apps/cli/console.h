#pragma once

#include <string>

#include <plisse/base/context.h>

namespace plisse {

/// How a run is shown while it goes on: a live line on a terminal, lines now and then, JSON lines on standard output,
/// or nothing. All but JSON go to standard error.
enum class ProgressStyle { bar, plain, json, quiet };

/// The style that `--progress auto|plain|json` and `--quiet` ask for; auto is a bar on a terminal, else plain lines.
ProgressStyle progress_style(const std::string& name, bool quiet);

/// Shows progress and messages, no more often than an eye (or a log) can use.
class Console final : public Context {
public:
    explicit Console(ProgressStyle style) : style_(style) {}
    ~Console() override { clear_bar(); }

    void on_progress(const Progress& progress) override;
    void on_message(const std::string& message) override;
    /// Takes the live line away, before other output.
    void clear_bar();

private:
    bool is_due(const Progress& progress);
    double seconds_left(double fraction) const;
    void show_bar(const Progress& progress);
    void show_line(const Progress& progress) const;
    void show_json(const Progress& progress) const;

    ProgressStyle style_;
    Stopwatch watch_;
    double shown_at_ = -1e9; ///< s
    int shown_level_ = -1;
    std::string shown_phase_;
    double first_fraction_ = -1; ///< a resumed run does not begin at 0
    bool bar_on_screen_ = false;
};

} // namespace plisse
