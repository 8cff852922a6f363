#pragma once

#include <memory>

#include <plisse/linalg/newton_system.h>

namespace plisse {

/// Supernodal sparse Cholesky factorisation of a NewtonSystem by CHOLMOD. The ordering is found on the graph of
/// vertices and kept, with the symbolic factor, for as long as the pattern allows. One thread, so the same bits always.
class SparseCholesky {
public:
    SparseCholesky();
    ~SparseCholesky();
    SparseCholesky(const SparseCholesky&) = delete;
    SparseCholesky& operator=(const SparseCholesky&) = delete;

    /// Factorises H + shift I. False when that is not positive definite.
    bool factorize(const NewtonSystem& system, double shift = 0);

    /// Forgets the ordering, so that what follows does not depend on what came before.
    void reset();

    /// Solves for the rows of the system (3 per row; see NewtonSystem::gather). Needs a successful factorize.
    VecX solve(const VecX& right_hand_side);

    int ordering_count() const; ///< how often a new ordering was computed
    double factor_nonzeros() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace plisse
