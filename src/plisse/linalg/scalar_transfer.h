#pragma once

#include <Eigen/SparseCore>

#include <plisse/base/types.h>

namespace plisse {

/// A sparse table of weights between vertices, fine x coarse; it acts alike on each of a vertex's three unknowns.
using ScalarTransfer = Eigen::SparseMatrix<double>;

/// S x: 3 per coarse vertex to 3 per fine one.
VecX prolonged(const ScalarTransfer& s, const VecX& coarse);
/// S' x: 3 per fine vertex to 3 per coarse one.
VecX restricted(const ScalarTransfer& s, const VecX& fine);

/// An upper bound of the 2-norm of S: the root of its largest absolute column sum times its largest absolute row sum.
double norm_bound(const ScalarTransfer& s);

} // namespace plisse
