#pragma once

#include <span>
#include <vector>

namespace plisse {

/// How a sparse Cholesky factorisation goes about a pattern. Rows that are eliminated one after the other and reach the
/// same rows below them form a front (a supernode): a dense matrix of its pivots and of what they reach (multifrontal
/// method, Duff and Reid 1983; Liu 1992). What a front leaves to do is added to its parent. Fronts are numbered so that
/// each comes after all those below it. Counts are in rows of 3x3 blocks.
struct Elimination {
    std::vector<int> order;                 ///< order[p] is the row eliminated as the p-th
    std::vector<int> first_pivot{0};        ///< front f has pivots first_pivot[f] <= p < first_pivot[f + 1]
    std::vector<int> parent;                ///< of every front; -1 at a root
    std::vector<std::vector<int>> children; ///< of every front, ascending; the last list is that of the roots
    std::vector<int> first_below;           ///< the lowest-numbered front of the subtree of every front
    std::vector<int> reach_starts{0};       ///< front f reaches reach[reach_starts[f]] .., ascending, behind its pivots
    std::vector<int> reach;
    std::vector<int> place;   ///< of each entry of reach: its row in the parent's front, whose pivots come first
    std::vector<double> cost; ///< estimated time of the subtree of every front, microseconds

    int row_count() const { return static_cast<int>(order.size()); }
    int front_count() const { return static_cast<int>(parent.size()); }
    int pivot_count(int front) const;
    std::span<const int> reach_of(int front) const;
    std::span<const int> place_of(int front) const;
    double factor_entries() const; ///< scalars of the factor, explicit zeros included
};

/// Analyses a lower triangle in compressed columns (block_rows ascending in each, the diagonal first) for elimination
/// in the given order of its rows, which is changed only where that changes no fill. Fronts are merged wherever a model
/// of the time says that one is cheaper than two.
Elimination analyze_elimination(std::span<const int> column_starts, std::span<const int> block_rows,
                                const std::vector<int>& order);

/// An order of little fill, by nested dissection of the pattern's graph (METIS).
/// Throws std::runtime_error when METIS fails.
std::vector<int> dissection_order(std::span<const int> column_starts, std::span<const int> block_rows);

} // namespace plisse
