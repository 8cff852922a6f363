#pragma once

#include <plisse/scene/scene.h>

namespace plisse {

/// The contact of a scene; parts are numbered in its order, bodies first.
ContactSettings contact_settings(const Scene& scene);

} // namespace plisse
