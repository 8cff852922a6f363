#include <plisse/linalg/coloring.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <deque>
#include <numeric>
#include <utility>

namespace plisse {

namespace {

/// The colours that each vertex has met, 64 a word, one array of words for all vertices per 64 colours.
class MetColors {
public:
    explicit MetColors(int vertex_count) : vertex_count_(static_cast<std::size_t>(vertex_count)) {}

    int take_lowest_free(std::span<const int> vertices) {
        for (std::size_t layer = 0;; ++layer) {
            if (layer == layers_.size())
                layers_.emplace_back(vertex_count_, 0);
            std::uint64_t met = 0;
            for (int v : vertices)
                met |= layers_[layer][static_cast<std::size_t>(v)];
            if (met == ~std::uint64_t{0})
                continue;
            const int bit = std::countr_one(met);
            for (int v : vertices)
                layers_[layer][static_cast<std::size_t>(v)] |= std::uint64_t{1} << bit;
            return static_cast<int>(64 * layer) + bit;
        }
    }

private:
    std::size_t vertex_count_;
    std::vector<std::vector<std::uint64_t>> layers_;
};

using VerticesOf = std::function<std::span<const int>(int)>;

std::vector<std::vector<int>> elements_around(int element_count, int vertex_count, const VerticesOf& vertices_of) {
    std::vector<std::vector<int>> around(static_cast<std::size_t>(vertex_count));
    for (int e = 0; e < element_count; ++e)
        for (int v : vertices_of(e))
            around[static_cast<std::size_t>(v)].push_back(e);
    return around;
}

/// Sorts elements into groups, breadth first within a group; what a group had reached when it was full is where the
/// next ones begin.
void grow_groups(int element_count, int vertex_count, int group_size, const VerticesOf& vertices_of,
                 ColoredGroups& groups) {
    const auto around = elements_around(element_count, vertex_count, vertices_of);
    std::vector<std::uint8_t> taken(static_cast<std::size_t>(element_count), 0);
    std::deque<int> seeds(static_cast<std::size_t>(element_count));
    std::iota(seeds.begin(), seeds.end(), 0);
    while (!seeds.empty()) {
        std::deque<int> reached{seeds.front()};
        seeds.pop_front();
        const std::size_t begin = groups.elements.size();
        while (!reached.empty() && groups.elements.size() - begin < static_cast<std::size_t>(group_size)) {
            const int element = reached.front();
            reached.pop_front();
            if (std::exchange(taken[static_cast<std::size_t>(element)], 1))
                continue;
            groups.elements.push_back(element);
            for (int v : vertices_of(element))
                for (int next : around[static_cast<std::size_t>(v)])
                    if (!taken[static_cast<std::size_t>(next)])
                        reached.push_back(next);
        }
        if (groups.elements.size() > begin)
            groups.group_starts.push_back(static_cast<int>(groups.elements.size()));
        seeds.insert(seeds.begin(), reached.begin(), reached.end());
    }
}

std::vector<int> vertices_of_group(const ColoredGroups& groups, int g, const VerticesOf& vertices_of) {
    std::vector<int> vertices;
    for (int element : groups.group(g))
        for (int v : vertices_of(element))
            vertices.push_back(v);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

} // namespace

Coloring color_elements(int element_count, int vertex_count, const VerticesOf& vertices_of) {
    MetColors met(vertex_count);
    std::vector<int> color_of(static_cast<std::size_t>(element_count));
    Coloring coloring;
    for (int e = 0; e < element_count; ++e) {
        const int color = met.take_lowest_free(vertices_of(e));
        color_of[static_cast<std::size_t>(e)] = color;
        if (color == coloring.color_count())
            coloring.starts.push_back(0);
        ++coloring.starts[static_cast<std::size_t>(color) + 1];
    }
    std::partial_sum(coloring.starts.begin(), coloring.starts.end(), coloring.starts.begin());
    coloring.order.resize(color_of.size());
    std::vector<int> next(coloring.starts.begin(), coloring.starts.end() - 1);
    for (int e = 0; e < element_count; ++e) {
        const auto color = static_cast<std::size_t>(color_of[static_cast<std::size_t>(e)]);
        coloring.order[static_cast<std::size_t>(next[color]++)] = e;
    }
    return coloring;
}

ColoredGroups color_groups(int element_count, int vertex_count, int group_size, const VerticesOf& vertices_of) {
    ColoredGroups groups;
    grow_groups(element_count, vertex_count, group_size, vertices_of, groups);
    std::vector<std::vector<int>> vertices;
    for (int g = 0; g + 1 < static_cast<int>(groups.group_starts.size()); ++g)
        vertices.push_back(vertices_of_group(groups, g, vertices_of));
    groups.coloring = color_elements(static_cast<int>(vertices.size()), vertex_count, [&](int g) {
        return std::span<const int>(vertices[static_cast<std::size_t>(g)]);
    });
    return groups;
}

} // namespace plisse
