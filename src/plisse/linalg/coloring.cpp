#include <plisse/linalg/coloring.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

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

} // namespace

Coloring color_elements(int element_count, int vertex_count,
                        const std::function<std::span<const int>(int)>& vertices_of) {
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

} // namespace plisse
