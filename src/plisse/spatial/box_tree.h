#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
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

    /// Calls visit(item) for each item whose box overlaps `box`.
    template <typename Visit>
    void visit_overlaps(const Box& box, const Visit& visit) const {
        const FloatBox query(box);
        visit_leaves(0, query, [&](int leaf) {
            for_each_set_bit(leaf_at(leaf).overlaps(query), [&](int k) { visit(item_at(leaf * leaf_size + k)); });
        });
    }

    /// Items lie in leaves of a few neighbours each. Queries leaf by leaf visit each pair of overlapping boxes once.
    int leaf_count() const { return static_cast<int>(node_of_leaf_.size()); }

    /// Calls visit(item, other) for overlapping items of this tree, the first of them in `leaf` and the other behind
    /// it.
    template <typename Visit>
    void visit_pairs_from(int leaf, const Visit& visit) const {
        const int start = node_of_leaf_[static_cast<std::size_t>(leaf)];
        visit_leaves(start, leaf_box(leaf), [&](int other) { visit_leaf_pairs(leaf, *this, other, visit); });
    }

    /// Calls visit(item, other) for overlapping items, the first in `leaf` of this tree and the other in another tree.
    template <typename Visit>
    void visit_pairs_from(int leaf, const BoxTree& tree, const Visit& visit) const {
        tree.visit_leaves(0, leaf_box(leaf), [&](int other) { visit_leaf_pairs(leaf, tree, other, visit); });
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

    /// The boxes of a leaf side by side, so that one is compared with all at a time; places left over hold empty boxes.
    struct Leaf {
        typedef float Bounds __attribute__((vector_size(leaf_size * sizeof(float))));
        typedef std::int32_t Bits __attribute__((vector_size(leaf_size * sizeof(std::int32_t))));
        std::array<Bounds, 3> low, high;

        Leaf();
        void set(std::size_t k, const FloatBox& box);
        FloatBox box(std::size_t k) const {
            FloatBox result;
            result.low = {low[0][k], low[1][k], low[2][k]};
            result.high = {high[0][k], high[1][k], high[2][k]};
            return result;
        }
        /// Bit k: whether box k overlaps the other.
        unsigned overlaps(const FloatBox& other) const {
            Bits bits = {1, 2, 4, 8};
            for (std::size_t axis = 0; axis < 3; ++axis)
                bits &= (low[axis] <= other.high[axis]) & (other.low[axis] <= high[axis]);
            return static_cast<unsigned>(bits[0] | bits[1] | bits[2] | bits[3]);
        }
    };

    template <typename Visit>
    static void for_each_set_bit(unsigned bits, const Visit& visit) {
        for (; bits != 0; bits &= bits - 1)
            visit(std::countr_zero(bits));
    }

    /// Nodes lie in depth-first order, so the next node is the first child, and `skip` the node after the whole
    /// subtree.
    struct Node {
        FloatBox box;
        int skip = 0;
        int leaf = -1; ///< -1 for an inner node
    };

    /// Calls visit(leaf) for the leaves from `node` on, in order, whose boxes overlap `box`.
    template <typename Visit>
    void visit_leaves(int node, const FloatBox& box, const Visit& visit) const {
        const int end = static_cast<int>(nodes_.size());
        while (node < end) {
            const Node& n = nodes_[static_cast<std::size_t>(node)];
            if (!n.box.overlaps(box)) {
                node = n.skip;
                continue;
            }
            if (n.leaf >= 0)
                visit(n.leaf);
            ++node;
        }
    }

    template <typename Visit>
    void visit_leaf_pairs(int leaf, const BoxTree& tree, int other, const Visit& visit) const {
        const bool same = &tree == this && leaf == other;
        for (int k = 0; k < end_of_leaf(leaf) - leaf * leaf_size; ++k) {
            const unsigned behind = same ? ~0U << (k + 1) : ~0U;
            const unsigned bits = tree.leaf_at(other).overlaps(leaf_at(leaf).box(static_cast<std::size_t>(k)));
            for_each_set_bit(bits & behind, [&](int other_k) {
                visit(item_at(leaf * leaf_size + k), tree.item_at(other * leaf_size + other_k));
            });
        }
    }

    int item_at(int position) const { return item_at_[static_cast<std::size_t>(position)]; }
    const Leaf& leaf_at(int leaf) const { return leaves_[static_cast<std::size_t>(leaf)]; }
    int end_of_leaf(int leaf) const { return std::min((leaf + 1) * leaf_size, size()); }
    const FloatBox& leaf_box(int leaf) const {
        return nodes_[static_cast<std::size_t>(node_of_leaf_[static_cast<std::size_t>(leaf)])].box;
    }

    void build(std::span<const Box> boxes, int begin, int end);

    std::vector<int> item_at_; ///< by position; those of one leaf follow each other
    std::vector<Leaf> leaves_;
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
        return find(
            tree.leaf_count(), most, [&](int leaf, const auto& visit) { tree.visit_pairs_from(leaf, visit); }, accept);
    }

    /// Pairs {i, j} of an item of `tree` and one of `other`, those of one item i next to each other with ascending j.
    /// Otherwise as find_within.
    template <typename Accept>
    bool find_between(const BoxTree& tree, const BoxTree& other, const Accept& accept, std::size_t most) {
        return find(
            tree.leaf_count(), most, [&](int leaf, const auto& visit) { tree.visit_pairs_from(leaf, other, visit); },
            accept);
    }

    const std::vector<Pair>& pairs() const { return pairs_; }

private:
    template <typename Query, typename Accept>
    bool find(int leaf_count, std::size_t most, const Query& query, const Accept& accept) {
        constexpr int chunk_size = 64;
        const int chunks = chunk_count(leaf_count, chunk_size);
        chunks_.resize(std::max(chunks_.size(), static_cast<std::size_t>(chunks)));
        std::atomic<std::size_t> total{0};
        parallel_chunks(leaf_count, chunk_size, [&](int c, int begin, int end) {
            auto& chunk = chunks_[static_cast<std::size_t>(c)];
            chunk.clear();
            for (int leaf = begin; leaf < end && total.load(std::memory_order_relaxed) <= most; ++leaf) {
                const std::size_t before = chunk.size();
                query(leaf, [&](int i, int j) {
                    if (accept(i, j))
                        chunk.push_back({i, j});
                });
                std::sort(chunk.begin() + static_cast<std::ptrdiff_t>(before), chunk.end());
                total.fetch_add(chunk.size() - before, std::memory_order_relaxed);
            }
        });
        pairs_.clear();
        if (total.load() > most)
            return false;
        pairs_.reserve(total.load());
        for (int c = 0; c < chunks; ++c)
            pairs_.insert(pairs_.end(), chunks_[static_cast<std::size_t>(c)].begin(),
                          chunks_[static_cast<std::size_t>(c)].end());
        return true;
    }

    std::vector<std::vector<Pair>> chunks_;
    std::vector<Pair> pairs_;
};

} // namespace plisse
