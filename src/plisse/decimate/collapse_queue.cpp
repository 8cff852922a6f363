#include <plisse/decimate/collapse_queue.h>

#include <algorithm>
#include <functional>

namespace plisse {

void CollapseQueue::push(int edge) {
    auto& heap = heaps_[edges_[edge].group];
    heap.push_back({edges_[edge].cost, edge});
    std::push_heap(heap.begin(), heap.end(), std::greater<>());
    edges_[edge].state = State::queued;
}

void CollapseQueue::add(const Edge& edge, int group, double cost) {
    const int number = static_cast<int>(edges_.size());
    edges_.push_back({edge, group, State::queued, cost});
    for (int v : edge)
        vertex_edges_[v].push_back(number);
    push(number);
}

int CollapseQueue::pop(int group) {
    auto& heap = heaps_[group];
    while (!heap.empty()) {
        std::pop_heap(heap.begin(), heap.end(), std::greater<>());
        const int edge = heap.back().edge;
        heap.pop_back();
        if (edges_[edge].state == State::queued) {
            edges_[edge].state = State::popped;
            return edge;
        }
    }
    return -1;
}

void CollapseQueue::wake(int vertex) {
    auto& around = vertex_edges_[vertex];
    std::erase_if(around, [&](int edge) { return edges_[edge].state == State::dead; });
    for (int edge : around)
        if (edges_[edge].state == State::parked)
            push(edge);
}

void CollapseQueue::remove_vertex(int vertex) {
    for (int edge : vertex_edges_[vertex])
        edges_[edge].state = State::dead;
    vertex_edges_[vertex] = {};
}

} // namespace plisse
