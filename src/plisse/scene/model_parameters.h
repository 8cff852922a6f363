#pragma once

#include <plisse/model/model.h>
#include <plisse/scene/scene.h>

namespace plisse {

/// Gives a model what its scene says beside shapes, selections and hierarchy: materials, pressures, motions, the values
/// of loads, pulls, gravity, contact and the solver's settings. The model has the bodies, obstacles, handles and loads
/// of the scene. Throws InputError for a pressure on a body without sides, and for pulls at vertices that are not
/// there.
void set_parameters(const Scene& scene, Model& model);

} // namespace plisse
