#pragma once

#include <atomic>
#include <string>

#include <plisse/base/timing.h>

namespace plisse {

/// Where a run stands, for a progress display.
struct Progress {
    int level = 0;
    int level_count = 1;
    std::string phase; ///< preview | settle | refine | final
    double time = 0;   ///< s of the timeline
    double duration = 0;
    int step = 0;
    int iteration = 0;
    double step_norm = 0; ///< largest nodal Newton step divided by the time step, m/s
    double gap = 0;       ///< smallest distance between surface primitives in contact range, m; infinity when none
    double fraction = 0;  ///< share of the whole run done, an estimate in [0, 1]
    int step_count = 0;   ///< steps that the phase takes; 0: nobody knows yet
};

/// Carries cancellation, progress, messages and timing through every stage of a run. The base class listens to nothing.
class Context {
public:
    virtual ~Context() = default;

    /// Called about once a solver iteration.
    virtual void on_progress(const Progress&) {}
    /// A sentence the user should read, such as a mesh that was repaired.
    virtual void on_message(const std::string&) {}

    /// Asks the run to end after the current step. Safe from another thread and from a signal handler.
    void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
    /// Takes that back, for a run that may be stopped and go on.
    void resume() { cancelled_.store(false, std::memory_order_relaxed); }
    bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

    PhaseTimes times;

private:
    std::atomic<bool> cancelled_{false};
};

} // namespace plisse
