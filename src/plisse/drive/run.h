#pragma once

#include <plisse/base/context.h>
#include <plisse/decimate/hierarchy_store.h>
#include <plisse/drive/recorder.h>
#include <plisse/model/model.h>

namespace plisse {

struct RunOptions {
    double until = -1;                     ///< stop the timeline at this time, s; negative: run to its end
    const Checkpoint* resume = nullptr;    ///< go on from here; the result has the same bytes as an uninterrupted run
    HierarchyStore* hierarchies = nullptr; ///< where to look for the hierarchy and to keep it; null: nowhere
};

/// What a run ended with.
struct RunResult {
    RunReport report;
    int level = 0;       ///< the finest level reached
    Positions positions; ///< its last state
};

/// Runs the model with its method to the end, to a cancel, or to a stall. Throws InputError for a model that cannot be
/// run (IntersectingSurfaces where they do at the start). Surfaces that are only nearer than the contact thickness are
/// moved apart.
RunResult run(const Model& model, const RunOptions& options, Recorder& recorder, Context& context);

} // namespace plisse
