#pragma once

#include <array>
#include <chrono>

namespace plisse {

/// The phases a run's time is divided into, as the report names them.
enum class Phase { elastic, contact, linear_solve, line_search, broad_phase, ccd, other };
inline constexpr int phase_count = 7;
const char* phase_name(Phase phase);

/// Seconds spent in each phase.
struct PhaseTimes {
    std::array<double, phase_count> seconds{};
    double& operator[](Phase phase) { return seconds[static_cast<std::size_t>(phase)]; }
    double operator[](Phase phase) const { return seconds[static_cast<std::size_t>(phase)]; }
    PhaseTimes& operator+=(const PhaseTimes& other);
    double total() const;
};

/// Wall-clock seconds since construction.
class Stopwatch {
public:
    Stopwatch() : start_(std::chrono::steady_clock::now()) {}
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_;
};

/// Adds the seconds of its own lifetime to one phase, and takes them off the enclosing scope's phase, so that phases
/// never overlap. Scopes nest on one thread only.
class PhaseScope {
public:
    PhaseScope(PhaseTimes& times, Phase phase);
    ~PhaseScope();
    PhaseScope(const PhaseScope&) = delete;
    PhaseScope& operator=(const PhaseScope&) = delete;

private:
    PhaseTimes& times_;
    Phase phase_;
    Stopwatch watch_;
    PhaseScope* outer_;
    double inner_seconds_ = 0;
};

} // namespace plisse
