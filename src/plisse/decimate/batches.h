#pragma once

#include <span>
#include <vector>

#include <plisse/decimate/hierarchy.h>

namespace plisse {

/// Orders the undoing of collapses first, ..., last - 1, the coarser ones being undone already, into batches (PSQ
/// algorithms 6 and 7). In a batch, {k} and the rings of all members are disjoint and present before the batch begins;
/// its members are listed newest first.
std::vector<std::vector<int>> expansion_batches(std::span<const Collapse> collapses, int first, int last,
                                                int vertex_id_count);

} // namespace plisse
