#pragma once

#include <plisse/base/context.h>
#include <plisse/scene/scene.h>

namespace plisse {

/// Loads and places every mesh of the scene, makes one mesh of them (bodies, then obstacles), and resolves selections,
/// loads and scripts. Says through the context what was changed on the way, such as faces that were fanned.
///
/// Throws InputError for meshes that cannot be used (unreadable, pinched, degenerate, of the wrong connectivity,
/// intersecting at rest or at the start; pairs of two obstacles do not count), for selections that select nothing, and
/// for handles that prescribe the same axis of a vertex, and for more levels by subdivision than memory could hold.
Model build_model(const Scene& scene, Context& context);

} // namespace plisse
