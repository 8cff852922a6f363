#pragma once

#include <nlohmann/json_fwd.hpp>

namespace plisse {

/// The JSON Schema (draft 2020-12) of scene files, with every key, default, limit and meaning, and the material presets
/// with their sources. It describes the whole format; what this version answers with "not supported" is marked so.
nlohmann::ordered_json scene_schema();

} // namespace plisse
