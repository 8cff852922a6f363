#pragma once

#include <plisse/drive/expanding_mesh.h>

namespace plisse {

/// How one expansion was made safe, in the order of the ladder (DESIGN.md section 7).
enum class Rung { toward_target, sampled, relaxed, failed };

/// Largest displacement of the vertices k will split into that cannot reach any face outside the faces around k and
/// its ring: a share of the distance to them and of the shortest edge at k. To be asked before the split.
double safe_radius(const ExpandingMesh& mesh, const Collapse& collapse);

/// Finds places for i and j within `radius` of where k was such that no face around them meets another one, by exact
/// predicates: toward their targets, else along stratified directions seeded by `seed` (PSQ section 4.4.1, algorithm
/// 5). The record has been split. Touches positions of i and j only, so the records of a batch may be done in parallel.
Rung perturb(ExpandingMesh& mesh, const Collapse& collapse, double radius, std::uint64_t seed);

/// Whether the faces around i and j meet any face that shares a vertex with them elsewhere than there.
bool patch_intersects(const ExpandingMesh& mesh, const Collapse& collapse);

} // namespace plisse
