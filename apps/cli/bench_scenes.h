#pragma once

#include <string>
#include <vector>

#include <plisse/scene/scene.h>

namespace plisse {

/// Names of the built-in benchmarks.
std::vector<std::string> bench_names();

/// The scene of a benchmark, progressive, on a mesh of several thousand vertices, or fewer when `quick` is set. Throws
/// InputError for a name that is not one.
Scene bench_scene(const std::string& name, bool quick);

} // namespace plisse
