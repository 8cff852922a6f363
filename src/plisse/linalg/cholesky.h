#pragma once

#include <cstddef>
#include <vector>

#include <plisse/linalg/elimination.h>
#include <plisse/linalg/newton_system.h>

namespace plisse {

/// Sparse Cholesky factorisation of a NewtonSystem by the multifrontal method, on all threads and with the same bits
/// for any number of them. The order of elimination is kept, with its analysis, for as long as the pattern allows.
class SparseCholesky {
public:
    SparseCholesky();

    /// Factorises H + shift I. False when that is not positive definite. Between two resets it is one and the same
    /// system, whose pattern_version tells when to analyse anew.
    bool factorize(const NewtonSystem& system, double shift = 0);

    /// Forgets the ordering, so that what follows does not depend on what came before.
    void reset();

    /// Solves for the rows of the system (3 per row; see NewtonSystem::gather). Needs a successful factorize.
    VecX solve(const VecX& right_hand_side);

    int ordering_count() const { return ordering_count_; } ///< how often a new ordering was computed
    double factor_nonzeros() const { return elimination_.factor_entries(); }

private:
    /// Where a block of the system goes in the panel of its front.
    struct Placement {
        int number;         ///< in NewtonSystem::blocks
        bool transposed;    ///< it lies below the diagonal of the system and above that of the factor
        std::size_t target; ///< of its first scalar in panels_
    };

    void analyze(const NewtonSystem& system);
    void place_blocks(const NewtonSystem& system);
    void lay_out_updates();
    int front_size(int front) const;
    int reach_size(int front) const;

    double worthwhile_task_cost() const;
    bool is_heavy(int front) const;
    template <typename Visit>
    void visit_upwards(int front, const Visit& visit) const;
    template <typename Visit>
    void visit_downwards(int front, const Visit& visit) const;

    void assemble(int front, const std::vector<Mat3>& blocks, double shift);
    void place_system_column(int pivot, int size, const std::vector<Mat3>& blocks);
    void add_update_column(int child, std::size_t j, double* column, int stride);
    bool eliminate(int front);

    Elimination elimination_;
    std::vector<Placement> placements_; ///< sorted by pivot
    std::vector<std::size_t> placement_starts_;
    std::vector<std::size_t> panel_starts_;
    VecX panels_; ///< of every front, its columns of the factor: all its rows times its pivots, column by column
    std::vector<std::size_t> update_starts_;
    VecX updates_; ///< of every front, what it leaves to its parent: lower triangle of reach times reach
    VecX carried_; ///< of every entry of Elimination::reach, what a solve carries from front to front
    int pattern_version_ = -1;
    int ordering_count_ = 0;
    double ordered_fill_ = 0;
    double task_cost_ = 0; ///< microseconds
};

} // namespace plisse
