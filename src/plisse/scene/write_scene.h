#pragma once

#include <nlohmann/json_fwd.hpp>

#include <plisse/scene/scene.h>

namespace plisse {

/// The scene as a file would hold it, defaults filled in: reading it again gives the same scene.
nlohmann::ordered_json scene_to_json(const Scene& scene);

} // namespace plisse
