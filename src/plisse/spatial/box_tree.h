#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <span>
#include <vector>

#include <plisse/base/parallel.h>
#include <plisse/spatial/box.h>

namespace plisse {

/// Bounding-volume tree over the boxes of items 0, 1, ... Its shape is decided once, by median splits of the boxes it
/// is built on; refitting keeps the shape. Boxes are kept in single precision, rounded outwards: a query may report
/// items whose boxes miss by a rounding, and never leaves one out. Results depend on nothing but the boxes.
class BoxTree {
public:
    BoxTree() = default;
    explicit BoxTree(std::span<const Box> boxes);

    /// Takes new boxes for the same items.
    void refit(std::span<const Box> boxes);

    int size() const { return static_cast<int>(item_at_.size()); }
    /// The item at a position of the tree's own, spatially coherent order.
    int item_at(int position) const { return item_at_[static_cast<std::size_t>(position)]; }

    /// Calls visit(item) for each item whose box overlaps `box`.
    template <typename Visit>
    void visit_overlaps(const Box& box, const Visit& visit) const {
        if (!nodes_.empty())
            visit_from(0, 0, FloatBox(box), visit);
    }

    /// Calls visit(item) for each item at a later position whose box overlaps that of the item at `position`: over all
    /// positions each overlapping pair comes up once.
    template <typename Visit>
    void visit_later_overlaps(int position, const Visit& visit) const {
        visit_from(static_cast<std::size_t>(node_of_leaf_[static_cast<std::size_t>(position / leaf_size)]),
                   position + 1, boxes_[static_cast<std::size_t>(position)], visit);
    }

private:
    static constexpr int leaf_size = 4;

    struct FloatBox {
        std::array<float, 3> low, high;

        FloatBox();
        explicit FloatBox(const Box& box);
        void include(const FloatBox& box);
        bool overlaps(const FloatBox& other) const {
            // No short cuts: six comparisons in a row beat six branches.
            return (low[0] <= other.high[0]) & (low[1] <= other.high[1]) & (low[2] <= other.high[2]) &
                   (other.low[0] <= high[0]) & (other.low[1] <= high[1]) & (other.low[2] <= high[2]);
        }
    };

    /// Nodes lie in depth-first order, so the next node is the first child, and `skip` the node after the whole
    /// subtree.
    struct Node {
        FloatBox box;
        int skip = 0;
        int first = -1; ///< position of the leaf's first item; -1 for an inner node
    };

    template <typename Visit>
    void visit_from(std::size_t node, int position, const FloatBox& box, const Visit& visit) const {
        const std::size_t end = nodes_.size();
        while (node < end) {
            const Node& n = nodes_[node];
            if (!n.box.overlaps(box)) {
                node = static_cast<std::size_t>(n.skip);
                continue;
            }
            if (n.first >= 0)
                for (int p = std::max(n.first, position); p < std::min(n.first + leaf_size, size()); ++p)
                    if (boxes_[static_cast<std::size_t>(p)].overlaps(box))
                        visit(item_at_[static_cast<std::size_t>(p)]);
            ++node;
        }
    }

    void build(std::span<const Box> boxes, int begin, int end);

    std::vector<int> item_at_;    ///< by position
    std::vector<FloatBox> boxes_; ///< by position
    std::vector<Node> nodes_;
    std::vector<int> node_of_leaf_;
};

/// Pairs of overlapping boxes, found in parallel and listed in an order that depends on nothing but the boxes. Keep the
/// object to keep its memory.
class OverlapPairs {
public:
    using Pair = std::array<int, 2>;

    /// Pairs {i, j} of items of one tree for which accept(i, j) holds. When there are more than `most`, lists none and
    /// returns false. accept is called from several threads.
    template <typename Accept>
    bool find_within(const BoxTree& tree, const Accept& accept, std::size_t most) {
        return find(tree.size(), most, [&](int position, std::vector<Pair>& found) {
            const int i = tree.item_at(position);
            tree.visit_later_overlaps(position, [&](int j) {
                if (accept(i, j))
                    found.push_back({i, j});
            });
        });
    }

    /// Pairs {i, j}: box i of `boxes` overlaps item j of the tree. Otherwise as find_within.
    template <typename Accept>
    bool find_between(std::span<const Box> boxes, const BoxTree& tree, const Accept& accept, std::size_t most) {
        return find(static_cast<int>(boxes.size()), most, [&](int i, std::vector<Pair>& found) {
            tree.visit_overlaps(boxes[static_cast<std::size_t>(i)], [&](int j) {
                if (accept(i, j))
                    found.push_back({i, j});
            });
        });
    }

    const std::vector<Pair>& pairs() const { return pairs_; }

private:
    template <typename Query>
    bool find(int count, std::size_t most, const Query& query) {
        constexpr int chunk_size = 256;
        chunks_.resize(std::max(chunks_.size(), static_cast<std::size_t>(chunk_count(count, chunk_size))));
        for (auto& chunk : chunks_)
            chunk.clear();
        std::atomic<std::size_t> total{0};
        parallel_chunks(count, chunk_size, [&](int c, int begin, int end) {
            auto& chunk = chunks_[static_cast<std::size_t>(c)];
            for (int i = begin; i < end && total.load(std::memory_order_relaxed) <= most; ++i) {
                const std::size_t before = chunk.size();
                query(i, chunk);
                total.fetch_add(chunk.size() - before, std::memory_order_relaxed);
            }
        });
        pairs_.clear();
        if (total.load() > most)
            return false;
        for (const auto& chunk : chunks_)
            pairs_.insert(pairs_.end(), chunk.begin(), chunk.end());
        return true;
    }

    std::vector<std::vector<Pair>> chunks_;
    std::vector<Pair> pairs_;
};

} // namespace plisse
