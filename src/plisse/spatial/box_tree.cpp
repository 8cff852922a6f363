#include <plisse/spatial/box_tree.h>

#include <cassert>
#include <cmath>
#include <numeric>

namespace plisse {

namespace {

/// More than the rounding of a conversion to float and of the subtraction that uses it.
float rounding_margin(float value) {
    return std::abs(value) * std::numeric_limits<float>::epsilon() + std::numeric_limits<float>::min();
}

float round_down(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest - rounding_margin(nearest);
}

float round_up(double value) {
    const auto nearest = static_cast<float>(value);
    return nearest + rounding_margin(nearest);
}

} // namespace

BoxTree::FloatBox::FloatBox() {
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
}

BoxTree::FloatBox::FloatBox(const Box& box) {
    for (int k = 0; k < 3; ++k) {
        low[static_cast<std::size_t>(k)] = round_down(box.low[k]);
        high[static_cast<std::size_t>(k)] = round_up(box.high[k]);
    }
}

void BoxTree::FloatBox::include(const FloatBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], box.low[k]);
        high[k] = std::max(high[k], box.high[k]);
    }
}

BoxTree::Leaf::Leaf() {
    for (std::size_t k = 0; k < leaf_size; ++k)
        set(k, FloatBox());
}

void BoxTree::Leaf::set(std::size_t k, const FloatBox& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis][k] = box.low[axis];
        high[axis][k] = box.high[axis];
    }
}

BoxTree::BoxTree(std::span<const Box> boxes)
    : item_at_(boxes.size()), leaves_((boxes.size() + leaf_size - 1) / leaf_size) {
    std::iota(item_at_.begin(), item_at_.end(), 0);
    if (!boxes.empty())
        build(boxes, 0, size());
    refit(boxes);
}

void BoxTree::build(std::span<const Box> boxes, int begin, int end) {
    const std::size_t node = nodes_.size();
    nodes_.emplace_back();
    if (end - begin <= leaf_size) {
        nodes_[node].leaf = begin / leaf_size;
        node_of_leaf_.push_back(static_cast<int>(node));
    } else {
        Box centers;
        const auto center = [&](int item) { return boxes[static_cast<std::size_t>(item)].center(); };
        for (int p = begin; p < end; ++p)
            centers.include(center(item_at(p)));
        int axis = 0;
        (centers.high - centers.low).maxCoeff(&axis);
        // Left halves hold whole leaves, so that every leaf but the last is full and positions tell their leaf.
        const int middle = begin + (end - begin + 2 * leaf_size - 1) / (2 * leaf_size) * leaf_size;
        std::nth_element(item_at_.begin() + begin, item_at_.begin() + middle, item_at_.begin() + end,
                         [&](int a, int b) {
                             const double ca = center(a)[axis], cb = center(b)[axis];
                             return ca != cb ? ca < cb : a < b;
                         });
        build(boxes, begin, middle);
        build(boxes, middle, end);
    }
    nodes_[node].skip = static_cast<int>(nodes_.size());
}

void BoxTree::refit(std::span<const Box> boxes) {
    assert(boxes.size() == item_at_.size());
    parallel_for(size(), 1024, [&](int p) {
        leaves_[static_cast<std::size_t>(p / leaf_size)].set(static_cast<std::size_t>(p % leaf_size),
                                                             FloatBox(boxes[static_cast<std::size_t>(item_at(p))]));
    });
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        Node& node = nodes_[n];
        node.box = FloatBox();
        if (node.leaf >= 0) {
            for (std::size_t k = 0; k < leaf_size; ++k)
                node.box.include(leaf_at(node.leaf).box(k));
        } else {
            const Node& first_child = nodes_[n + 1];
            node.box.include(first_child.box);
            node.box.include(nodes_[static_cast<std::size_t>(first_child.skip)].box);
        }
    }
}

} // namespace plisse
