#pragma once

#include "bench_arguments.h"

namespace plisse {

/// The tables 3 to 8 and figures 9 and 10 of Kopanicakova, Krause and Tamstorf (2019) beside ours, and rmtr beside the
/// single-level trust region: seconds, iterations and memory over sizes. Every contestant runs in a process of its own.
void run_rmtr_bench(const BenchArguments& arguments);

} // namespace plisse
