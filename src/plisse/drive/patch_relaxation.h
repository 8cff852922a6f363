#pragma once

#include <span>

#include <plisse/base/context.h>
#include <plisse/drive/expanding_mesh.h>

namespace plisse {

/// Opens gaps around a few vertices: minimises membrane energy and barrier contact over `free` alone, all else held,
/// with a barrier that stiffens tenfold a round until every pair in reach is at least `wanted_gap` apart or the rounds
/// are over (PSQ section 4.4.3). Never makes an intersection. Returns the smallest distance reached, m.
double relax_patch(ExpandingMesh& mesh, std::span<const int> free, double wanted_gap, Context& context);

/// A collapse's ring with the vertices that are there now: k before the split, i and j after it.
std::vector<int> patch_vertices(const ExpandingMesh& mesh, const Collapse& collapse);

} // namespace plisse
