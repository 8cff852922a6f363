#include <plisse/linalg/elimination.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include <metis.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Lists one behind the other: list i is values[starts[i]] .. values[starts[i + 1] - 1].
struct Lists {
    std::vector<int> starts, values;
    std::span<const int> operator[](int i) const {
        return std::span(values).subspan(at(starts[at(i)]), at(starts[at(i) + 1] - starts[at(i)]));
    }
};

/// A pattern whose rows are numbered in the order of elimination.
class OrderedPattern {
public:
    OrderedPattern(std::span<const int> column_starts, std::span<const int> block_rows, const std::vector<int>& order)
        : column_starts_(column_starts), block_rows_(block_rows), position_(order.size()) {
        for (std::size_t p = 0; p < order.size(); ++p)
            position_[at(order[p])] = static_cast<int>(p);
    }

    /// Of every row, the rows before it that it is coupled with.
    Lists earlier() const {
        return lists([](int, int late) { return late; }, [](int early, int) { return early; });
    }
    /// Of every row, the rows behind it that it is coupled with.
    Lists later() const {
        return lists([](int early, int) { return early; }, [](int, int late) { return late; });
    }

private:
    template <typename Visit>
    void for_each_pair(const Visit& visit) const {
        for (std::size_t c = 0; c < position_.size(); ++c)
            for (int k = column_starts_[c] + 1; k < column_starts_[c + 1]; ++k) {
                const int a = position_[c], b = position_[at(block_rows_[at(k)])];
                visit(std::min(a, b), std::max(a, b));
            }
    }

    template <typename Key, typename Value>
    Lists lists(const Key& key, const Value& value) const {
        Lists result;
        result.starts.assign(position_.size() + 1, 0);
        for_each_pair([&](int early, int late) { ++result.starts[at(key(early, late)) + 1]; });
        std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
        result.values.resize(at(result.starts.back()));
        std::vector<int> next(result.starts.begin(), result.starts.end() - 1);
        for_each_pair(
            [&](int early, int late) { result.values[at(next[at(key(early, late))]++)] = value(early, late); });
        return result;
    }

    std::span<const int> column_starts_, block_rows_;
    std::vector<int> position_;
};

/// Parent of every row: the first one that its elimination changes (Liu 1990, with path compression).
std::vector<int> elimination_tree(const Lists& earlier) {
    const int n = static_cast<int>(earlier.starts.size()) - 1;
    std::vector<int> parent(at(n), -1), ancestor(at(n), -1);
    for (int row = 0; row < n; ++row)
        for (int p : earlier[row])
            while (p != -1 && p < row) {
                const int next = ancestor[at(p)];
                ancestor[at(p)] = row;
                if (next == -1)
                    parent[at(p)] = row;
                p = next;
            }
    return parent;
}

/// The nodes of a forest, each after all those below it.
std::vector<int> postorder(const std::vector<int>& parent) {
    const int n = static_cast<int>(parent.size());
    std::vector<int> child(at(n), -1), sibling(at(n), -1), order, stack;
    for (int v = n - 1; v >= 0; --v)
        if (parent[at(v)] >= 0) {
            sibling[at(v)] = child[at(parent[at(v)])];
            child[at(parent[at(v)])] = v;
        }
    for (int root = 0; root < n; ++root) {
        if (parent[at(root)] >= 0)
            continue;
        stack.push_back(root);
        while (!stack.empty()) {
            const int v = stack.back();
            const int below = child[at(v)];
            if (below >= 0) {
                child[at(v)] = sibling[at(below)];
                stack.push_back(below);
            } else {
                order.push_back(v);
                stack.pop_back();
            }
        }
    }
    return order;
}

/// Entries of each column of the factor, the diagonal included: one walk up the tree for each entry of a row.
std::vector<int> column_counts(const Lists& earlier, const std::vector<int>& tree) {
    const int n = static_cast<int>(tree.size());
    std::vector<int> count(at(n), 1), seen(at(n), -1);
    for (int row = 0; row < n; ++row) {
        seen[at(row)] = row;
        for (int start : earlier[row])
            for (int p = start; seen[at(p)] != row; p = tree[at(p)]) {
                seen[at(p)] = row;
                ++count[at(p)];
            }
    }
    return count;
}

/// Time in microseconds that a front of so many pivots and rows in all takes: for being there, for the entries that are
/// cleared, gathered and handed on, and for the arithmetic. Decision 0008 has the measurements.
double front_cost(int pivots, int rows) {
    const double k = 3.0 * pivots, rest = 3.0 * (rows - pivots);
    const double entries = rest * rest + k * (k + rest);
    const double operations = k * rest * (rest + k) + k * k * k / 3;
    return 2 + 1e-3 * entries + 5e-5 * operations;
}

/// A front while fronts are being merged.
struct Front {
    std::vector<int> columns; ///< its pivots, in an order of elimination
    int rows = 0;             ///< pivots and reach
    int parent = -1;
    bool merged = false; ///< into its parent

    int pivots() const { return static_cast<int>(columns.size()); }
};

/// Runs of columns with the same reach. Every column must come right after its descendants.
std::vector<Front> fundamental_fronts(const std::vector<int>& tree, const std::vector<int>& count) {
    const int n = static_cast<int>(tree.size());
    std::vector<Front> fronts;
    std::vector<int> front_of(at(n));
    for (int p = 0; p < n; ++p) {
        const bool same = p > 0 && tree[at(p) - 1] == p && count[at(p) - 1] == count[at(p)] + 1;
        if (!same)
            fronts.push_back({{}, count[at(p)]});
        fronts.back().columns.push_back(p);
        front_of[at(p)] = static_cast<int>(fronts.size()) - 1;
    }
    for (Front& front : fronts) {
        const int above = tree[at(front.columns.back())];
        front.parent = above < 0 ? -1 : front_of[at(above)];
    }
    return fronts;
}

/// Merges fronts into their parents where that saves time, from the leaves up, those that reach most first.
void merge_fronts(std::vector<Front>& fronts) {
    std::vector<std::vector<int>> children(fronts.size());
    for (std::size_t f = 0; f < fronts.size(); ++f) {
        Front& front = fronts[f];
        std::vector<int> candidates = std::move(children[f]);
        std::stable_sort(candidates.begin(), candidates.end(),
                         [&](int a, int b) { return fronts[at(a)].rows > fronts[at(b)].rows; });
        std::vector<int> kept;
        for (int c : candidates) {
            Front& child = fronts[at(c)];
            const double apart = front_cost(child.pivots(), child.rows) + front_cost(front.pivots(), front.rows);
            if (front_cost(child.pivots() + front.pivots(), child.pivots() + front.rows) >= apart) {
                kept.push_back(c);
                continue;
            }
            front.rows += child.pivots();
            front.columns.insert(front.columns.begin(), child.columns.begin(), child.columns.end());
            child.merged = true;
            kept.insert(kept.end(), children[at(c)].begin(), children[at(c)].end());
        }
        for (int c : kept)
            fronts[at(c)].parent = static_cast<int>(f);
        children[f] = std::move(kept);
        if (front.parent >= 0)
            children[at(front.parent)].push_back(static_cast<int>(f));
    }
}

/// Numbers the fronts that are left and their pivots, children first.
void number_fronts(const std::vector<Front>& fronts, const std::vector<int>& order, Elimination& result) {
    std::vector<int> kept, index(fronts.size(), -1), parent;
    for (std::size_t f = 0; f < fronts.size(); ++f)
        if (!fronts[f].merged) {
            index[f] = static_cast<int>(kept.size());
            kept.push_back(static_cast<int>(f));
        }
    for (int f : kept)
        parent.push_back(fronts[at(f)].parent < 0 ? -1 : index[at(fronts[at(f)].parent)]);
    const std::vector<int> sequence = postorder(parent);
    std::vector<int> number(kept.size());
    for (std::size_t s = 0; s < sequence.size(); ++s)
        number[at(sequence[s])] = static_cast<int>(s);
    for (int k : sequence) {
        const Front& front = fronts[at(kept[at(k)])];
        for (int column : front.columns)
            result.order.push_back(order[at(column)]);
        result.first_pivot.push_back(static_cast<int>(result.order.size()));
        result.parent.push_back(parent[at(k)] < 0 ? -1 : number[at(parent[at(k)])]);
        result.cost.push_back(front_cost(front.pivots(), front.rows));
    }
    result.children.resize(kept.size() + 1);
    for (std::size_t f = 0; f < kept.size(); ++f)
        result.children[result.parent[f] < 0 ? kept.size() : at(result.parent[f])].push_back(static_cast<int>(f));
    result.first_below.resize(kept.size());
    std::iota(result.first_below.begin(), result.first_below.end(), 0);
    for (std::size_t f = 0; f < kept.size(); ++f)
        if (const int above = result.parent[f]; above >= 0) {
            result.first_below[at(above)] = std::min(result.first_below[at(above)], result.first_below[f]);
            result.cost[at(above)] += result.cost[f];
        }
}

/// Finds what every front reaches: what its pivots are coupled with, and what its children hand on.
void find_reach(const Lists& later, Elimination& e) {
    std::vector<int> seen(e.order.size(), -1), row(e.order.size());
    for (int f = 0; f < e.front_count(); ++f) {
        const int first = e.first_pivot[at(f)], end = e.first_pivot[at(f) + 1];
        const auto start = static_cast<std::ptrdiff_t>(e.reach.size());
        const auto add = [&](int p) {
            if (p >= end && seen[at(p)] != f) {
                seen[at(p)] = f;
                e.reach.push_back(p);
            }
        };
        for (int p = first; p < end; ++p)
            for (int q : later[p])
                add(q);
        for (int c : e.children[at(f)])
            for (int k = e.reach_starts[at(c)]; k < e.reach_starts[at(c) + 1]; ++k)
                add(e.reach[at(k)]);
        std::sort(e.reach.begin() + start, e.reach.end());
        e.reach_starts.push_back(static_cast<int>(e.reach.size()));

        int rows = 0;
        for (int p = first; p < end; ++p)
            row[at(p)] = rows++;
        for (int p : e.reach_of(f))
            row[at(p)] = rows++;
        e.place.resize(e.reach.size());
        for (int c : e.children[at(f)])
            for (int k = e.reach_starts[at(c)]; k < e.reach_starts[at(c) + 1]; ++k)
                e.place[at(k)] = row[at(e.reach[at(k)])];
    }
}

} // namespace

int Elimination::pivot_count(int front) const {
    return first_pivot[at(front) + 1] - first_pivot[at(front)];
}

std::span<const int> Elimination::reach_of(int front) const {
    const int start = reach_starts[at(front)];
    return std::span(reach).subspan(at(start), at(reach_starts[at(front) + 1] - start));
}

std::span<const int> Elimination::place_of(int front) const {
    const int start = reach_starts[at(front)];
    return std::span(place).subspan(at(start), at(reach_starts[at(front) + 1] - start));
}

double Elimination::factor_entries() const {
    double entries = 0;
    for (int f = 0; f < front_count(); ++f) {
        const double pivots = 3.0 * pivot_count(f);
        entries += pivots * (pivots + 1) / 2 + pivots * 3.0 * static_cast<double>(reach_of(f).size());
    }
    return entries;
}

Elimination analyze_elimination(std::span<const int> column_starts, std::span<const int> block_rows,
                                const std::vector<int>& order) {
    const Lists unsorted = OrderedPattern(column_starts, block_rows, order).earlier();
    std::vector<int> sorted;
    for (int p : postorder(elimination_tree(unsorted)))
        sorted.push_back(order[at(p)]);

    const Lists earlier = OrderedPattern(column_starts, block_rows, sorted).earlier();
    const std::vector<int> tree = elimination_tree(earlier);
    std::vector<Front> fronts = fundamental_fronts(tree, column_counts(earlier, tree));
    merge_fronts(fronts);

    Elimination result;
    number_fronts(fronts, sorted, result);
    find_reach(OrderedPattern(column_starts, block_rows, result.order).later(), result);
    return result;
}

std::vector<int> dissection_order(std::span<const int> column_starts, std::span<const int> block_rows) {
    const std::size_t n = column_starts.size() - 1;
    std::vector<std::vector<idx_t>> neighbours(n);
    for (std::size_t c = 0; c < n; ++c)
        for (int k = column_starts[c] + 1; k < column_starts[c + 1]; ++k) {
            const int r = block_rows[at(k)];
            neighbours[c].push_back(r);
            neighbours[at(r)].push_back(static_cast<idx_t>(c));
        }
    std::vector<idx_t> starts{0}, adjacent;
    for (const auto& list : neighbours) {
        adjacent.insert(adjacent.end(), list.begin(), list.end());
        starts.push_back(static_cast<idx_t>(adjacent.size()));
    }
    std::vector<idx_t> order(n), position(n);
    std::iota(order.begin(), order.end(), 0);
    auto count = static_cast<idx_t>(n);
    if (!adjacent.empty() && METIS_NodeND(&count, starts.data(), adjacent.data(), nullptr, nullptr, order.data(),
                                          position.data()) != METIS_OK)
        throw std::runtime_error("METIS could not order the matrix");
    return {order.begin(), order.end()};
}

} // namespace plisse
