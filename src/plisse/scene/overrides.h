#pragma once

#include <optional>
#include <string>

#include <plisse/scene/scene.h>

namespace plisse {

/// Puts a method (by its name in scene files) and a level in place of the scene's own. A method given without a level
/// takes away a level that only the scene's method could use. Throws InputError naming the option for a method this
/// version does not have, and for a level that is not there or not for this method.
void override_solve(Scene& scene, const std::optional<std::string>& method, const std::optional<int>& level);

} // namespace plisse
