#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <plisse/base/parallel.h>
#include <plisse/linalg/elimination.h>
#include <plisse/linalg/newton_system.h>
#include <plisse/linalg/panel_cholesky.h>

namespace plisse {

/// What a factorisation by fronts needs to know of a NewtonSystem's pattern, whatever the precision of its numbers: the
/// order of elimination, where each block goes, where each front's numbers lie, and which subtrees are tasks. Sizes are
/// in scalars.
class FrontPlan {
public:
    /// Where a block of the system goes in the panel of its front.
    struct Placement {
        int number;         ///< in NewtonSystem::blocks
        bool transposed;    ///< it lies below the diagonal of the system and above that of the factor
        std::size_t target; ///< of its first scalar among those of all panels
    };

    /// Analyses the system where its pattern has changed, in the same order for as long as that serves. Between two
    /// resets it is one and the same system, whose pattern_version tells.
    void adapt_to(const NewtonSystem& system);

    /// Forgets the order, so that what follows does not depend on what came before.
    void reset();

    int ordering_count() const { return ordering_count_; } ///< how often a new order was computed

    const Elimination& elimination() const { return elimination_; }
    /// Of a front: all its rows, the rows of its pivots, and the rows that it reaches behind those.
    int front_size(int front) const { return pivot_size(front) + reach_size(front); }
    int pivot_size(int front) const { return 3 * elimination_.pivot_count(front); }
    int reach_size(int front) const { return 3 * static_cast<int>(elimination_.reach_of(front).size()); }

    /// A front's panel is its columns of the factor: all its rows times its pivots, column by column, with as many rows
    /// of no meaning at the end of each as factorize_panel wants.
    int panel_rows(int front) const {
        return (front_size(front) + panel_row_multiple - 1) / panel_row_multiple * panel_row_multiple;
    }
    std::size_t panel_start(int front) const { return panel_starts_[static_cast<std::size_t>(front)]; }
    std::size_t panel_room() const { return panel_starts_.back(); }
    /// Its update is what it leaves to its parent: the lower triangle of reach times reach.
    std::size_t update_start(int front) const { return update_starts_[static_cast<std::size_t>(front)]; }
    std::size_t update_room() const { return update_room_; }

    std::span<const Placement> placements_of(int pivot) const {
        const std::size_t begin = placement_starts_[static_cast<std::size_t>(pivot)];
        return std::span(placements_).subspan(begin, placement_starts_[static_cast<std::size_t>(pivot) + 1] - begin);
    }

    /// Calls visit(front) for every front, children before parents; for those of unlike subtrees possibly at a time.
    template <typename Visit>
    void visit_upwards(const Visit& visit) const {
        visit_upwards(elimination_.front_count(), visit);
    }
    /// The same with parents before children.
    template <typename Visit>
    void visit_downwards(const Visit& visit) const {
        visit_downwards(elimination_.front_count(), visit);
    }

private:
    void place_blocks(const NewtonSystem& system);
    void lay_out_updates();
    double worthwhile_task_cost() const;

    /// Subtrees worth a task of their own. front_count() stands for what is above the roots.
    bool is_heavy(int front) const {
        return front == elimination_.front_count() || elimination_.cost[static_cast<std::size_t>(front)] > task_cost_;
    }
    template <typename Visit>
    void visit_upwards(int front, const Visit& visit) const {
        if (!is_heavy(front)) {
            for (int f = elimination_.first_below[static_cast<std::size_t>(front)]; f <= front; ++f)
                visit(f);
            return;
        }
        const auto& children = elimination_.children[static_cast<std::size_t>(front)];
        parallel_for(static_cast<int>(children.size()), 1,
                     [&](int c) { visit_upwards(children[static_cast<std::size_t>(c)], visit); });
        if (front < elimination_.front_count())
            visit(front);
    }
    template <typename Visit>
    void visit_downwards(int front, const Visit& visit) const {
        if (!is_heavy(front)) {
            for (int f = front; f >= elimination_.first_below[static_cast<std::size_t>(front)]; --f)
                visit(f);
            return;
        }
        if (front < elimination_.front_count())
            visit(front);
        const auto& children = elimination_.children[static_cast<std::size_t>(front)];
        parallel_for(static_cast<int>(children.size()), 1,
                     [&](int c) { visit_downwards(children[static_cast<std::size_t>(c)], visit); });
    }

    Elimination elimination_;
    std::vector<Placement> placements_; ///< sorted by pivot
    std::vector<std::size_t> placement_starts_;
    std::vector<std::size_t> panel_starts_{0};
    std::vector<std::size_t> update_starts_;
    std::size_t update_room_ = 0;
    int pattern_version_ = -1;
    int ordering_count_ = 0;
    double ordered_fill_ = 0;
    double task_cost_ = 0; ///< microseconds
};

} // namespace plisse
