#include <plisse/energy/colored_elements.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace plisse {

ColoredElements::ColoredElements(int element_count, int vertex_count, int group_size, VerticesOf vertices_of)
    : element_count_(element_count), vertices_of_(std::move(vertices_of)),
      groups_(color_groups(element_count, vertex_count, group_size, vertices_of_)) {}

void ColoredElements::place_in(const NewtonSystem& system) {
    block_numbers_.clear();
    block_starts_.clear();
    for (int element = 0; element < element_count_; ++element) {
        block_starts_.push_back(block_numbers_.size());
        system.append_base_blocks(vertices_of_(element), block_numbers_);
    }
}

const int* ColoredElements::block_numbers(int element) const {
    assert(block_starts_.size() == static_cast<std::size_t>(element_count_) && "place_in comes first");
    return block_numbers_.data() + block_starts_[static_cast<std::size_t>(element)];
}

std::vector<Edge> ColoredElements::pairs() const {
    std::vector<Edge> pairs;
    for (int element = 0; element < element_count_; ++element) {
        const std::span<const int> vertices = vertices_of_(element);
        for (std::size_t j = 1; j < vertices.size(); ++j)
            for (std::size_t i = 0; i < j; ++i)
                pairs.push_back({std::min(vertices[i], vertices[j]), std::max(vertices[i], vertices[j])});
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
}

} // namespace plisse
