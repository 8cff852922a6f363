#pragma once

#include <functional>
#include <span>
#include <vector>

namespace plisse {

/// Elements sorted by colour; those of one colour share no vertex, so a parallel loop over them may add to vertices.
/// Adding colour after colour gives the same bits for any number of threads.
struct Coloring {
    std::vector<int> order;     ///< elements by colour, ascending within a colour
    std::vector<int> starts{0}; ///< colour c holds order[starts[c]] .. order[starts[c + 1] - 1]
    int color_count() const { return static_cast<int>(starts.size()) - 1; }
    std::span<const int> elements(int color) const {
        const auto c = static_cast<std::size_t>(color);
        return std::span(order).subspan(static_cast<std::size_t>(starts[c]),
                                        static_cast<std::size_t>(starts[c + 1] - starts[c]));
    }
};

/// Greedy: each element in turn takes the lowest colour that none of its vertices has met. vertices_of(e) gives the
/// vertices of element e, in [0, vertex_count). Costs O(vertices of e * colours/64) an element.
Coloring color_elements(int element_count, int vertex_count,
                        const std::function<std::span<const int>(int)>& vertices_of);

/// Elements in groups that lie together, the groups sorted by colour: whoever adds group by group stays in the cache,
/// and waits for others a few times only.
struct ColoredGroups {
    std::vector<int> elements;        ///< by group
    std::vector<int> group_starts{0}; ///< group g holds elements[group_starts[g]] .. elements[group_starts[g + 1] - 1]
    Coloring coloring;                ///< of the groups, by the vertices of their elements
    std::span<const int> group(int g) const {
        const auto begin = static_cast<std::size_t>(group_starts[static_cast<std::size_t>(g)]);
        const auto end = static_cast<std::size_t>(group_starts[static_cast<std::size_t>(g) + 1]);
        return std::span(elements).subspan(begin, end - begin);
    }
};

/// Groups of at most group_size elements, each grown from one element over shared vertices, the next one beside it.
ColoredGroups color_groups(int element_count, int vertex_count, int group_size,
                           const std::function<std::span<const int>(int)>& vertices_of);

} // namespace plisse
