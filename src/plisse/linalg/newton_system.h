#pragma once

#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// The symmetric matrix H of a Newton step, in 3x3 blocks (one row of blocks per vertex), together with what the
/// prescribed unknowns add to the right-hand side. Unknowns come in three kinds of vertices: free, prescribed in some
/// axes, prescribed in all. The last kind has no row at all; prescribed axes of the second kind become unit rows.
///
/// Use: set_prescribed_step(u), begin(extra blocks), add blocks for every element, then matrix and coupling() are
/// ready. Blocks may be added from several threads as long as no two calls at a time share a vertex.
class NewtonSystem {
public:
    NewtonSystem() = default;
    /// prescribed: one flag per unknown (3 per vertex). pairs: the vertex pairs that elements always couple, in the
    /// order in which their blocks shall lie in memory; a vertex may pair with itself, and otherwise comes last.
    NewtonSystem(std::vector<std::uint8_t> prescribed, std::span<const Edge> pairs);

    int vertex_count() const { return static_cast<int>(row_of_vertex_.size()); }
    int row_count() const { return static_cast<int>(vertex_of_row_.size()); }
    const std::vector<std::uint8_t>& prescribed() const { return prescribed_; }

    /// The step u that the prescribed unknowns take in this iteration (3 per vertex; zero where free).
    void set_prescribed_step(const VecX& u);

    /// Zeroes H and H u, and makes room for the pairs of elements that come and go. The pattern only grows when a pair
    /// is new, and is pruned back when too little of it is used; either raises pattern_version().
    void begin(std::span<const Edge> extra_pairs);

    /// Drops what extra pairs have added to the pattern, so that what follows does not depend on what came before.
    void reset_pattern();

    /// Adds an element's matrix (3k x 3k, symmetric) over its k distinct vertices.
    template <typename Derived>
    void add(std::span<const int> vertices, const Eigen::MatrixBase<Derived>& element) {
        for_each_lower_block(vertices, [&](int i, int j, int local_i, int local_j) {
            add_block(i, j, element.template block<3, 3>(3 * local_i, 3 * local_j));
        });
    }
    /// Adds block (i, j), i >= j, and by symmetry its transpose at (j, i).
    template <typename Derived>
    void add_block(int i, int j, const Eigen::MatrixBase<Derived>& block) {
        const int row = free_row_[static_cast<std::size_t>(i)];
        const int column = free_row_[static_cast<std::size_t>(j)];
        add_block_at(row >= 0 && column >= 0 ? number_of(row, column) : -1, i, j, block);
    }

    /// Number of block (i, j), i >= j, for add_block_at: who adds to it again and again searches for it once. It holds
    /// for as long as the system lives; the pair is one that the system was made with. -1 where unknowns are
    /// prescribed.
    int base_block(int i, int j) const;
    /// Appends the numbers of an element's blocks in the order in which the other `add` wants them.
    void append_base_blocks(std::span<const int> vertices, std::vector<int>& numbers) const;
    template <typename Derived>
    void add_block_at(int number, int i, int j, const Eigen::MatrixBase<Derived>& block) {
        if (number >= 0)
            blocks_[static_cast<std::size_t>(number)] += block;
        else
            add_prescribed_block(i, j, block);
    }
    template <typename Derived>
    void add(std::span<const int> vertices, const int* numbers, const Eigen::MatrixBase<Derived>& element) {
        add_blocks(vertices, numbers, [&](int i, int j) { return element.template block<3, 3>(3 * i, 3 * j); });
    }
    /// The same for an element matrix whose blocks are made when they are asked for: block(i, j) of local vertices.
    template <typename Block>
    void add_blocks(std::span<const int> vertices, const int* numbers, const Block& block) {
        for_each_lower_block(vertices, [&](int i, int j, int local_i, int local_j) {
            add_block_at(*numbers++, i, j, block(local_i, local_j));
        });
    }

    /// H u over all unknowns, 3 per vertex.
    const VecX& coupling() const { return coupling_; }

    /// Lower triangle in compressed columns of blocks: rows of column c are block_rows[column_starts[c] ...),
    /// ascending, the diagonal first; the k-th block's value is blocks[block_numbers[k]].
    const std::vector<int>& column_starts() const { return column_starts_; }
    const std::vector<int>& block_rows() const { return block_rows_; }
    const std::vector<int>& block_numbers() const { return block_numbers_; }
    const std::vector<Mat3>& blocks() const { return blocks_; }
    int pattern_version() const { return pattern_version_; }

    /// H v, for rows v.
    VecX multiply(const VecX& rows) const;

    /// Copies the free part of an n-vertex vector into rows and back (prescribed scalars read and write zero).
    VecX gather(const VecX& vertices) const;
    VecX scatter(const VecX& rows) const;

private:
    /// Calls visit(i, j, local i, local j) for an element's blocks with i >= j, column by column.
    template <typename Visit>
    static void for_each_lower_block(std::span<const int> vertices, const Visit& visit) {
        for (std::size_t j = 0; j < vertices.size(); ++j)
            for (std::size_t i = 0; i < vertices.size(); ++i)
                if (vertices[i] >= vertices[j])
                    visit(vertices[i], vertices[j], static_cast<int>(i), static_cast<int>(j));
    }
    /// One or both of the vertices are prescribed in some axes.
    void add_prescribed_block(int i, int j, const Mat3& block);
    void number_base_blocks(std::span<const Edge> pairs);
    void reserve_pattern(std::span<const Edge> extra_pairs);
    /// keys: of the blocks that extra pairs add, ascending.
    void set_extra_blocks(std::vector<std::uint64_t> keys);

    /// The block's place in the pattern, counted without branches: columns are short, and a search would mispredict. -1
    /// if none.
    int find_block(int row, int column) const {
        const int begin = column_starts_[static_cast<std::size_t>(column)];
        const int end = column_starts_[static_cast<std::size_t>(column) + 1];
        int found = begin;
        for (int k = begin; k < end; ++k)
            found += block_rows_[static_cast<std::size_t>(k)] < row;
        return found < end && block_rows_[static_cast<std::size_t>(found)] == row ? found : -1;
    }
    int number_of(int row, int column) const {
        const int place = find_block(row, column);
        assert(place >= 0 && "block outside the pattern: pass its pair to begin()");
        return block_numbers_[static_cast<std::size_t>(place)];
    }

    std::vector<std::uint8_t> prescribed_;
    std::vector<int> row_of_vertex_; ///< -1 where all three axes are prescribed
    std::vector<int> free_row_;      ///< the same, also -1 where some are
    std::vector<int> vertex_of_row_;
    std::vector<std::uint8_t> partly_prescribed_; ///< per vertex
    std::vector<std::uint64_t> base_keys_;        ///< ascending
    std::vector<int> base_numbers_;               ///< of the blocks of base_keys_
    std::vector<std::uint64_t> extra_keys_;       ///< ascending; numbered after those
    std::vector<int> column_starts_{0};
    std::vector<int> block_rows_, block_numbers_;
    std::vector<Mat3> blocks_;
    VecX prescribed_step_;
    VecX coupling_;
    int pattern_version_ = 0;
};

} // namespace plisse
