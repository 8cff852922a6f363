#pragma once

#include <optional>

#include <plisse/drive/run.h>

#include "exact_intersections.h"

namespace plisse {

/// Keeps what a run says, and counts what intersects in its frames by exact predicates; can cancel it after some
/// checkpoints.
struct Witness : Recorder {
    explicit Witness(Context* cancelled = nullptr, int checkpoints_before_cancel = 0)
        : context(cancelled), left(checkpoints_before_cancel) {}
    void on_hierarchy(const Hierarchy& h) override { hierarchy = h; }
    void on_frame(const Frame& frame) override {
        const HierarchyLevel& level = hierarchy.levels[static_cast<std::size_t>(frame.level)];
        intersections += count_intersections(*frame.positions, level, 1);
        refined += frame.phase == "refine";
    }
    void on_checkpoint(const Checkpoint& checkpoint) override {
        last = checkpoint;
        if (context && --left == 0)
            context->cancel();
    }
    Context* context;
    int left;
    Hierarchy hierarchy;
    int intersections = 0, refined = 0;
    std::optional<Checkpoint> last;
};

inline RunResult run_to_end(const Model& model, Witness& witness, const RunOptions& options = {}) {
    Context context;
    return run(model, options, witness, context);
}

} // namespace plisse
