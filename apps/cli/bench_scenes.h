#pragma once

#include <string>

#include <plisse/scene/scene.h>

namespace plisse {

/// The scene of the benchmark "can" or "twist", progressive, on a mesh of several thousand vertices, or fewer when
/// `quick` is set.
Scene bench_scene(const std::string& name, bool quick);

} // namespace plisse
