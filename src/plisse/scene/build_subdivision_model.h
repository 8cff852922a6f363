#pragma once

#include <plisse/base/context.h>
#include <plisse/model/subdivision_model.h>
#include <plisse/scene/scene.h>

namespace plisse {

/// Loads and places the quad mesh of an rmtr scene, subdivides it, and finds the parts of its boundary that handles
/// hold. A selection takes points of the finest limit surface's boundary; `vertices` are those of the body's own mesh,
/// and two that are the ends of a side take all of it. Sides with both ends taken are held along their length, points
/// beside them alone.
///
/// Throws InputError for what the method does not know (other than one body, moving obstacles, friction, loads,
/// pressure, rest and start shapes, strain limits, bending scales), for meshes that cannot be subdivided, for
/// selections that take nothing of the boundary, for more levels than memory could hold, and IntersectingSurfaces where
/// they do at rest.
SubdivisionModel build_subdivision_model(const Scene& scene, Context& context);

} // namespace plisse
