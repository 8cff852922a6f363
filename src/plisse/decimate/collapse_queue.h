#pragma once

#include <cstdint>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// Edges waiting to be collapsed, the cheapest first, ties by number. An edge that was refused is parked until
/// something around it changes. As vertex ids are never reused, an edge keeps its cost as long as it lives.
class CollapseQueue {
public:
    /// Edges come in groups, each with an order of its own.
    CollapseQueue(int group_count, int vertex_id_count) : heaps_(group_count), vertex_edges_(vertex_id_count) {}

    void add(const Edge& edge, int group, double cost);
    /// Takes the cheapest edge of a group: its number, or -1 when none is left.
    int pop(int group);
    const Edge& edge(int number) const { return edges_[number].vertices; }
    /// Puts a popped edge aside.
    void park(int edge) { edges_[edge].state = State::parked; }
    /// Queues the parked edges of a vertex again.
    void wake(int vertex);
    /// Ends the life of all edges of a vertex.
    void remove_vertex(int vertex);

private:
    enum class State : std::uint8_t { queued, popped, parked, dead };
    struct Item {
        Edge vertices;
        int group;
        State state;
        double cost;
    };
    struct Entry {
        double cost;
        int edge;
        bool operator>(const Entry& other) const { return cost != other.cost ? cost > other.cost : edge > other.edge; }
    };

    void push(int edge);

    std::vector<Item> edges_;
    std::vector<std::vector<Entry>> heaps_;      // least entry first
    std::vector<std::vector<int>> vertex_edges_; // dead ones are weeded out when met
};

} // namespace plisse
