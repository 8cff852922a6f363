#include <plisse/linalg/cholesky.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <numeric>

#include <cblas.h>

#include <plisse/base/parallel.h>

/// LAPACK's Cholesky factorisation of a dense matrix, which OpenBLAS has and its C header leaves out.
extern "C" void dpotrf_(const char* triangle, const int* size, double* matrix, const int* stride, int* failed_at);

namespace plisse {

namespace {

using MatrixMap = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

std::size_t triangle_room(int size) {
    constexpr std::size_t alignment = 8; // whole cache lines, so that the bits cannot depend on where a front lies
    return (at(size) * at(size) + alignment - 1) / alignment * alignment;
}

/// Makes room, with some to spare: memory that is new each time would cost more than the analysis.
void grow(VecX& storage, std::size_t size) {
    if (static_cast<std::size_t>(storage.size()) < size)
        storage.resize(static_cast<Eigen::Index>(size + size / 4));
}

} // namespace

SparseCholesky::SparseCholesky() {
    openblas_set_num_threads(1); // fronts are worked on at a time instead; a team's sums would depend on its size
}

bool SparseCholesky::factorize(const NewtonSystem& system, double shift) {
    if (pattern_version_ != system.pattern_version()) {
        analyze(system);
        pattern_version_ = system.pattern_version();
    }
    std::atomic<bool> definite = true;
    visit_upwards(elimination_.front_count(), [&](int front) {
        if (!definite)
            return;
        assemble(front, system.blocks(), shift);
        if (!eliminate(front))
            definite = false;
    });
    return definite;
}

void SparseCholesky::reset() {
    elimination_ = {};
    pattern_version_ = -1;
}

VecX SparseCholesky::solve(const VecX& right_hand_side) {
    const Elimination& e = elimination_;
    assert(right_hand_side.size() == 3 * e.row_count());
    VecX x(right_hand_side.size());
    for (int p = 0; p < e.row_count(); ++p)
        x.segment<3>(3 * p) = right_hand_side.segment<3>(3 * e.order[at(p)]);

    const auto pivots_of = [&](int f) { return x.segment(3 * e.first_pivot[at(f)], 3 * e.pivot_count(f)); };
    const auto carried_of = [&](int f) { return carried_.segment(3 * e.reach_starts[at(f)], reach_size(f)); };
    const auto panel_of = [&](int f) {
        const int size = front_size(f);
        return MatrixMap(panels_.data() + panel_starts_[at(f)], size, size - reach_size(f), Eigen::OuterStride<>(size));
    };
    visit_upwards(e.front_count(), [&](int f) {
        auto pivots = pivots_of(f);
        auto carried = carried_of(f);
        const int pivot_count = e.pivot_count(f);
        carried.setZero();
        for (int c : elimination_.children[at(f)]) {
            const auto place = e.place_of(c);
            const auto from = carried_of(c);
            for (std::size_t i = 0; i < place.size(); ++i) {
                const auto part = from.segment<3>(3 * static_cast<int>(i));
                if (place[i] < pivot_count)
                    pivots.segment<3>(3 * place[i]) += part;
                else
                    carried.segment<3>(3 * (place[i] - pivot_count)) += part;
            }
        }
        const auto panel = panel_of(f);
        panel.topRows(panel.cols()).triangularView<Eigen::Lower>().solveInPlace(pivots);
        carried.noalias() -= panel.bottomRows(carried.size()) * pivots;
    });
    visit_downwards(e.front_count(), [&](int f) {
        auto pivots = pivots_of(f);
        auto carried = carried_of(f);
        const auto reach = e.reach_of(f);
        for (std::size_t i = 0; i < reach.size(); ++i)
            carried.segment<3>(3 * static_cast<int>(i)) = x.segment<3>(3 * reach[i]);
        const auto panel = panel_of(f);
        pivots.noalias() -= panel.bottomRows(carried.size()).transpose() * carried;
        panel.topRows(panel.cols()).triangularView<Eigen::Lower>().transpose().solveInPlace(pivots);
    });

    VecX solution(x.size());
    for (int p = 0; p < e.row_count(); ++p)
        solution.segment<3>(3 * e.order[at(p)]) = x.segment<3>(3 * p);
    return solution;
}

int SparseCholesky::reach_size(int front) const {
    return 3 * static_cast<int>(elimination_.reach_of(front).size());
}

int SparseCholesky::front_size(int front) const {
    return 3 * elimination_.pivot_count(front) + reach_size(front);
}

/// Subtrees worth a task of their own. front_count() stands for what is above the roots.
bool SparseCholesky::is_heavy(int front) const {
    return front == elimination_.front_count() || elimination_.cost[at(front)] > task_cost_;
}

/// A few tasks for each thread: more would be no faster, and each needs a workspace of its own, where one for all stays
/// in the cache.
double SparseCholesky::worthwhile_task_cost() const {
    constexpr double least_microseconds = 300;
    constexpr int tasks_per_thread = 8;
    double total = 0;
    for (int root : elimination_.children.back())
        total += elimination_.cost[at(root)];
    return thread_count() == 1 ? total : std::max(least_microseconds, total / (tasks_per_thread * thread_count()));
}

/// Calls visit for the fronts of a subtree, children before parents; those of unlike subtrees possibly at a time.
template <typename Visit>
void SparseCholesky::visit_upwards(int front, const Visit& visit) const {
    if (!is_heavy(front)) {
        for (int f = elimination_.first_below[at(front)]; f <= front; ++f)
            visit(f);
        return;
    }
    const auto& children = elimination_.children[at(front)];
    parallel_for(static_cast<int>(children.size()), 1, [&](int c) { visit_upwards(children[at(c)], visit); });
    if (front < elimination_.front_count())
        visit(front);
}

/// The same with parents before children.
template <typename Visit>
void SparseCholesky::visit_downwards(int front, const Visit& visit) const {
    if (!is_heavy(front)) {
        for (int f = front; f >= elimination_.first_below[at(front)]; --f)
            visit(f);
        return;
    }
    if (front < elimination_.front_count())
        visit(front);
    const auto& children = elimination_.children[at(front)];
    parallel_for(static_cast<int>(children.size()), 1, [&](int c) { visit_downwards(children[at(c)], visit); });
}

void SparseCholesky::analyze(const NewtonSystem& system) {
    constexpr double fill_worth_reordering = 1.15;
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
        panel_starts_.push_back(panel_starts_.back() + at(front_size(f)) * at(3 * elimination_.pivot_count(f)));
    grow(panels_, panel_starts_.back());
    grow(carried_, 3 * elimination_.reach.size());
    place_blocks(system);
    task_cost_ = worthwhile_task_cost();
    lay_out_updates();
}

void SparseCholesky::place_blocks(const NewtonSystem& system) {
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
                                          panel_starts_[at(f)] + 3 * at(column) * at(front_size(f)) + 3 * at(row)};
    });
}

/// Gives every front a place for its update in one of two halves of a workspace, in turn by its depth, such that one is
/// used again as soon as the parent has taken the update over: a front is written while its children, in the other
/// half, are read, and what lies below those is needed no more. Subtrees that may be visited at a time share nothing.
void SparseCholesky::lay_out_updates() {
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
    grow(updates_, room[at(fronts)].own + room[at(fronts)].other);
}

/// Gathers a front: the blocks of the system in its pivots' columns, and what its children leave. It goes by columns of
/// blocks, each cleared and filled while it is in the cache. A leaf's update is left to eliminate().
void SparseCholesky::assemble(int front, const std::vector<Mat3>& blocks, double shift) {
    const int size = front_size(front), reach = reach_size(front), pivots = size - reach;
    const auto& children = elimination_.children[at(front)];
    std::vector<std::size_t> taken(children.size(), 0); // columns of blocks of each child's update
    for (int row = 0; row < (children.empty() ? pivots : size); row += 3) {
        const bool pivotal = row < pivots;
        const int stride = pivotal ? size : reach;
        double* column = pivotal // from its diagonal block down
                             ? panels_.data() + panel_starts_[at(front)] + at(row) * at(size + 1)
                             : updates_.data() + update_starts_[at(front)] + at(row - pivots) * at(reach + 1);
        for (int b = 0; b < 3; ++b)
            std::fill_n(column + b * stride, size - row, 0.0);
        if (pivotal)
            place_system_column(elimination_.first_pivot[at(front)] + row / 3, size, blocks);
        for (int b = 0; pivotal && b < 3; ++b)
            column[b * (size + 1)] += shift;
        for (std::size_t c = 0; c < children.size(); ++c) {
            const auto place = elimination_.place_of(children[c]);
            if (taken[c] < place.size() && 3 * place[taken[c]] == row)
                add_update_column(children[c], taken[c]++, column, stride);
        }
    }
}

/// Copies the system's blocks of one pivot into their places in the panel, whose columns are `size` apart.
void SparseCholesky::place_system_column(int pivot, int size, const std::vector<Mat3>& blocks) {
    for (std::size_t i = placement_starts_[at(pivot)]; i < placement_starts_[at(pivot) + 1]; ++i) {
        const Placement& placement = placements_[i];
        const double* source = blocks[at(placement.number)].data();
        const int across = placement.transposed ? 1 : 3, down = placement.transposed ? 3 : 1;
        double* target = panels_.data() + placement.target;
        for (int b = 0; b < 3; ++b)
            for (int a = 0; a < 3; ++a)
                target[b * size + a] = source[b * across + a * down];
    }
}

/// Adds column j of blocks of a child's update, from its diagonal block down, to the column of the parent where it
/// belongs.
void SparseCholesky::add_update_column(int child, std::size_t j, double* column, int stride) {
    const auto place = elimination_.place_of(child);
    const std::size_t height = 3 * place.size();
    const double* source = updates_.data() + update_starts_[at(child)] + 3 * j * height;
    for (std::size_t i = j; i < place.size(); ++i) {
        const double* from = source + 3 * i;
        double* to = column + 3 * (place[i] - place[j]);
        for (int b = 0; b < 3; ++b)
            for (int a = 0; a < 3; ++a)
                to[b * stride + a] += from[at(b) * height + at(a)];
    }
}

/// Turns the panel of an assembled front into columns of the factor, and subtracts them from its update.
bool SparseCholesky::eliminate(int front) {
    const int size = front_size(front), reach = reach_size(front), pivots = size - reach;
    double* panel = panels_.data() + panel_starts_[at(front)];
    int failed_at = 0;
    dpotrf_("L", &pivots, panel, &size, &failed_at);
    if (failed_at != 0)
        return false;
    if (reach == 0)
        return true;
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, reach, pivots, 1, panel, size,
                panel + pivots, size);
    const double updated = elimination_.children[at(front)].empty() ? 0 : 1; // 0 clears what the memory holds
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, reach, pivots, -1, panel + pivots, size, updated,
                updates_.data() + update_starts_[at(front)], reach);
    return true;
}

} // namespace plisse
