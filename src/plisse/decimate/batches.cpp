#include <plisse/decimate/batches.h>

#include <algorithm>
#include <functional>

namespace plisse {

namespace {

/// Calls visit(v) for the vertices an expansion touches.
template <typename Visit>
void for_each_touched(const Collapse& collapse, const Visit& visit) {
    visit(collapse.k);
    for (int v : collapse.ring)
        visit(v);
}

/// Which expansions must wait for which: an expansion needs its vertices, and those that a newer collapse consumed come
/// back only when that is undone.
class Dependencies {
public:
    Dependencies(std::span<const Collapse> collapses, int first, int last, int vertex_id_count)
        : first_(first), waiting_for_(last - first), dependants_(last - first) {
        std::vector<int> consumer(vertex_id_count, -1);
        for (int c = first; c < last; ++c)
            consumer[collapses[c].i] = consumer[collapses[c].j] = c;
        for (int c = first; c < last; ++c)
            for_each_touched(collapses[c], [&](int v) {
                if (consumer[v] < 0)
                    return;
                ++waiting_for_[c - first];
                dependants_[consumer[v] - first].push_back(c);
            });
    }

    bool is_ready(int c) const { return waiting_for_[c - first_] == 0; }

    /// Appends those that become ready.
    void undo(int c, std::vector<int>& ready) {
        for (int dependant : dependants_[c - first_])
            if (--waiting_for_[dependant - first_] == 0)
                ready.push_back(dependant);
    }

private:
    int first_;
    std::vector<int> waiting_for_;
    std::vector<std::vector<int>> dependants_;
};

} // namespace

std::vector<std::vector<int>> expansion_batches(std::span<const Collapse> collapses, int first, int last,
                                                int vertex_id_count) {
    Dependencies dependencies(collapses, first, last, vertex_id_count);
    std::vector<int> ready;
    for (int c = first; c < last; ++c)
        if (dependencies.is_ready(c))
            ready.push_back(c);
    std::vector<std::vector<int>> batches;
    std::vector<int> touched_in(vertex_id_count, -1); // the last batch that touched a vertex
    while (!ready.empty()) {
        std::sort(ready.begin(), ready.end(), std::greater<>());
        const int number = static_cast<int>(batches.size());
        std::vector<int>& batch = batches.emplace_back();
        std::vector<int> next;
        for (int c : ready) {
            bool is_free = true;
            for_each_touched(collapses[c], [&](int v) { is_free = is_free && touched_in[v] != number; });
            if (is_free)
                for_each_touched(collapses[c], [&](int v) { touched_in[v] = number; });
            (is_free ? batch : next).push_back(c);
        }
        for (int c : batch)
            dependencies.undo(c, next);
        ready = std::move(next);
    }
    return batches;
}

} // namespace plisse
