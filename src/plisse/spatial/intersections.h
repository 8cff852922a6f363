#pragma once

#include <functional>
#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// Whether two triangles of a mesh meet anywhere but in shared vertices or a shared edge, by exact predicates. Two
/// neighbours folded flat onto each other meet.
bool faces_intersect(const ConstPositions& positions, const Face& a, const Face& b);

/// All intersecting pairs (a < b) of faces, ascending. Pairs for which skip(a, b) is true are left out (such as two
/// obstacles); skip may be empty and is called from several threads. At most `most` pairs are returned (the count then
/// is a lower bound).
std::vector<std::array<int, 2>> intersecting_pairs(const ConstPositions& positions, std::span<const Face> faces,
                                                   const std::function<bool(int, int)>& skip = {}, int most = 1 << 30);

} // namespace plisse
