#pragma once

#include <plisse/decimate/hierarchy.h>
#include <plisse/model/model.h>

namespace plisse {

/// A model whose mesh is level 0 of a subdivided hierarchy, on the finest level of it. start: of bodies, on the finest
/// level. A vertex belongs to the handles of its label, and to a load when all vertices that it lies between do; its
/// mesh has no attributes.
Model finest_model(const Model& model, const Hierarchy& hierarchy, const Positions& start,
                   const std::vector<std::vector<int>>& handles_of_label);

} // namespace plisse
