#pragma once

#include <plisse/decimate/hierarchy.h>
#include <plisse/transfer/prolongation.h>

namespace plisse {

/// Weights of affine prolongation (Liu and Jacobson 2019, section 5): every collapse on the way from level `from` up to
/// level `to` is undone by the affine map that fits the motion of the fresh vertex and of its ring best from their rest
/// state, and the weights of those steps are multiplied. One row for every vertex of `to`, one column for every vertex
/// of `from`; rows sum to 1, some weights are negative, and the more levels, the denser the rows.
ProlongationWeights affine_weights(const Hierarchy& hierarchy, int from, int to);

} // namespace plisse
