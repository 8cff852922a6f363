#pragma once

#include <functional>

#include <plisse/linalg/newton_system.h>

namespace plisse {

/// The largest eigenvalue of a symmetric positive definite map of vectors of a size: the Lanczos method's Ritz value
/// after so many steps from a fixed random start, which is no more than the eigenvalue, and near it long before the
/// steps have spanned the space (Golub and Van Loan, Matrix Computations, section 10.1).
double largest_eigenvalue(Eigen::Index size, const std::function<VecX(const VecX&)>& apply, int steps = 100);

/// The ratio of the extreme eigenvalues of H, the lowest by way of a factor; infinite where H is not positive definite
/// to the precision of a factorisation.
double condition_number(const NewtonSystem& matrix);

} // namespace plisse
