#pragma once

#include <plisse/drive/run.h>
#include <plisse/model/subdivision_model.h>

namespace plisse {

/// Runs the model by the method rmtr (Kopanicakova, Krause and Tamstorf 2019) or one that it is compared with: implicit
/// Euler steps with `dynamics`, else an equilibrium at every time of the timeline; with `settle`, one at its end.
/// Frames show the finest level's limit surface. RunOptions::hierarchies is not used.
RunResult run_multiscale(const SubdivisionModel& model, const RunOptions& options, Recorder& recorder,
                         Context& context);

} // namespace plisse
