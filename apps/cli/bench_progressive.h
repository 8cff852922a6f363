#pragma once

#include "bench_arguments.h"

namespace plisse {

/// Runs a scene of bench_scenes progressively and directly, side by side, each with several time steps; prints times by
/// phase, and ratios of the fastest of both.
void run_progressive_bench(const BenchArguments& arguments);

} // namespace plisse
