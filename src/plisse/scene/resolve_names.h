#pragma once

#include <plisse/scene/scene.h>

namespace plisse {

/// Gives nameless bodies, obstacles and handles names by number. Throws InputError when a name is taken twice (bodies
/// and obstacles share their names, as do obstacles and handles, which the report lists together) and when a handle,
/// a load or a contact pair names what is not there.
void resolve_names(Scene& scene);

} // namespace plisse
