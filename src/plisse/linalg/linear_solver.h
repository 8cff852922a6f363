#pragma once

#include <plisse/linalg/cholesky.h>

namespace plisse {

/// Solves for Newton steps. H is factorised in single precision, in little more than half the time and memory, and
/// conjugate gradients with that factor as preconditioner make up in double precision for what it lacks (iterative
/// refinement in mixed precision; Higham and Mary 2022). Where single precision does not do, the factor is in double
/// from there on.
class LinearSolver {
public:
    /// Factorises H if it is positive definite to the precision at hand; false if not.
    bool try_factorize(const NewtonSystem& system);

    /// Factorises H + shift I, and returns the shift: the least of 0, a, 10 a, 100 a, ..., with a 1e-12 of H's largest
    /// entry, with which that is positive definite in double precision.
    double factorize(const NewtonSystem& system);

    /// Forgets the order of elimination and the precision, so that what follows does not depend on what came before.
    void reset();

    /// x with (H + shift I) x = b, to about a millionth of its energy norm, for the rows of the system (3 per row; see
    /// NewtonSystem::gather). Needs a factor, and the system as it was. Where H turns out to be indefinite, x ends
    /// early with x . b > 0, which is still a direction of descent.
    VecX solve(const NewtonSystem& system, const VecX& right_hand_side);
    /// The same to the precision of the factor, for about half the time.
    VecX solve_roughly(const VecX& right_hand_side);

private:
    enum class Precision { single, full };

    FrontPlan plan_;
    SparseCholesky<float> single_;
    SparseCholesky<double> full_;
    Precision precision_ = Precision::single;
};

} // namespace plisse
