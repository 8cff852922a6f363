#include <plisse/linalg/front_plan.h>

#include <algorithm>
#include <numeric>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

std::size_t triangle_room(int size) {
    constexpr std::size_t alignment = 16; // whole cache lines, so that the bits cannot depend on where a front lies
    return (at(size) * at(size) + alignment - 1) / alignment * alignment;
}

} // namespace

void FrontPlan::adapt_to(const NewtonSystem& system) {
    constexpr double fill_worth_reordering = 1.15;
    if (pattern_version_ == system.pattern_version())
        return;
    pattern_version_ = system.pattern_version();
    const auto analyze_in = [&](const std::vector<int>& order) {
        elimination_ = analyze_elimination(system.column_starts(), system.block_rows(), order);
    };
    const bool ordered = elimination_.row_count() == system.row_count();
    if (ordered)
        analyze_in(std::vector<int>(elimination_.order));
    if (!ordered || elimination_.factor_entries() > fill_worth_reordering * ordered_fill_) {
        analyze_in(dissection_order(system.column_starts(), system.block_rows()));
        ordered_fill_ = elimination_.factor_entries();
        ++ordering_count_;
    }

    panel_starts_.assign(1, 0);
    for (int f = 0; f < elimination_.front_count(); ++f)
        panel_starts_.push_back(panel_starts_.back() + at(panel_rows(f)) * at(pivot_size(f)));
    place_blocks(system);
    task_cost_ = worthwhile_task_cost();
    lay_out_updates();
}

void FrontPlan::reset() {
    elimination_ = {};
    pattern_version_ = -1;
}

/// A few tasks for each thread: more would be no faster, and each needs a workspace of its own, where one for all stays
/// in the cache.
double FrontPlan::worthwhile_task_cost() const {
    constexpr double least_microseconds = 300;
    constexpr int tasks_per_thread = 8;
    double total = 0;
    for (int root : elimination_.children.back())
        total += elimination_.cost[at(root)];
    return thread_count() == 1 ? total : std::max(least_microseconds, total / (tasks_per_thread * thread_count()));
}

void FrontPlan::place_blocks(const NewtonSystem& system) {
    const Elimination& e = elimination_;
    std::vector<int> position(e.order.size()), front_of(e.order.size());
    for (int f = 0; f < e.front_count(); ++f)
        for (int p = e.first_pivot[at(f)]; p < e.first_pivot[at(f) + 1]; ++p) {
            position[at(e.order[at(p)])] = p;
            front_of[at(p)] = f;
        }
    const auto row_in_front = [&](int f, int p) {
        if (p < e.first_pivot[at(f) + 1])
            return p - e.first_pivot[at(f)];
        const auto reach = e.reach_of(f);
        return e.pivot_count(f) + static_cast<int>(std::lower_bound(reach.begin(), reach.end(), p) - reach.begin());
    };
    // Counting sort by pivot: sizes, then starts, then each block at the next place of its pivot.
    const auto& starts = system.column_starts();
    const auto& rows = system.block_rows();
    const auto for_each_block = [&](const auto& visit) {
        for (int c = 0; c < e.row_count(); ++c)
            for (int k = starts[at(c)]; k < starts[at(c) + 1]; ++k)
                visit(k, position[at(c)], position[at(rows[at(k)])]);
    };
    placement_starts_.assign(at(e.row_count()) + 1, 0);
    for_each_block([&](int, int a, int b) { ++placement_starts_[at(std::min(a, b)) + 1]; });
    std::partial_sum(placement_starts_.begin(), placement_starts_.end(), placement_starts_.begin());
    placements_.resize(rows.size());
    std::vector<std::size_t> next(placement_starts_.begin(), placement_starts_.end() - 1);
    for_each_block([&](int k, int a, int b) {
        const int pivot = std::min(a, b), f = front_of[at(pivot)];
        const int column = row_in_front(f, pivot), row = row_in_front(f, std::max(a, b));
        placements_[next[at(pivot)]++] = {system.block_numbers()[at(k)], b < a,
                                          panel_starts_[at(f)] + 3 * at(column) * at(panel_rows(f)) + 3 * at(row)};
    });
}

/// Gives every front a place for its update in one of two halves of a workspace, in turn by its depth, such that one is
/// used again as soon as the parent has taken the update over: a front is written while its children, in the other
/// half, are read, and what lies below those is needed no more. Subtrees that may be visited at a time share nothing.
void FrontPlan::lay_out_updates() {
    const int fronts = elimination_.front_count();
    struct Room {
        std::size_t own = 0, other = 0; ///< in the half of the front's own update, and in that of its children's
    };
    std::vector<Room> room(at(fronts) + 1);
    for (int f = 0; f <= fronts; ++f) {
        Room& mine = room[at(f)];
        std::size_t before = 0;
        for (int c : elimination_.children[at(f)]) {
            const Room& theirs = room[at(c)];
            mine.own = is_heavy(f) ? mine.own + theirs.other : std::max(mine.own, theirs.other);
            mine.other = std::max(mine.other, before + theirs.own);
            before += is_heavy(f) ? theirs.own : triangle_room(reach_size(c));
        }
        if (f < fronts)
            mine.own = std::max(mine.own, triangle_room(reach_size(f)));
    }
    std::vector<Room> start(at(fronts) + 1);
    start[at(fronts)] = {0, room[at(fronts)].own};
    update_starts_.resize(at(fronts));
    for (int f = fronts; f >= 0; --f) {
        Room next = start[at(f)];
        if (f < fronts)
            update_starts_[at(f)] = next.own;
        for (int c : elimination_.children[at(f)]) {
            start[at(c)] = {next.other, next.own};
            next.own += is_heavy(f) ? room[at(c)].other : 0;
            next.other += is_heavy(f) ? room[at(c)].own : triangle_room(reach_size(c));
        }
    }
    update_room_ = room[at(fronts)].own + room[at(fronts)].other;
}

} // namespace plisse
