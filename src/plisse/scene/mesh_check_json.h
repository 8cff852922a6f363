#pragma once

#include <nlohmann/json_fwd.hpp>

#include <plisse/mesh/check_mesh.h>

namespace plisse {

/// The counts of a check, as `plisse check --json` gives them.
nlohmann::ordered_json counts_json(const MeshCheck& check);

} // namespace plisse
