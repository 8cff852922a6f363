#pragma once

#include <map>

#include <plisse/drive/run.h>

#include "exact_intersections.h"

namespace plisse {

/// Judges every frame with predicates that share no code with the solver, and keeps the last one of each level.
struct Judge : Recorder {
    explicit Judge(int count) : bodies(count) {}
    void on_hierarchy(const Hierarchy& h) override { hierarchy = h; }
    void on_frame(const Frame& frame) override {
        const HierarchyLevel& level = hierarchy.levels[static_cast<std::size_t>(frame.level)];
        intersections += count_intersections(*frame.positions, level, bodies);
        last[frame.level] = *frame.positions;
        ++frames;
    }
    void on_iteration(const IterationRecord&) override { ++iterations; }
    int bodies;
    Hierarchy hierarchy;
    std::map<int, Positions> last;
    int intersections = 0, frames = 0, iterations = 0;
};

} // namespace plisse
