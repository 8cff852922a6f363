#pragma once

#include <cassert>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <plisse/base/types.h>

namespace plisse {

/// The symmetric matrix H of a Newton step, in 3x3 blocks (one row of blocks per vertex), together with what the
/// prescribed unknowns add to the right-hand side. Unknowns come in three kinds of vertices: free, prescribed in some
/// axes, prescribed in all. The last kind has no row at all; prescribed axes of the second kind become unit rows.
///
/// Use: set_prescribed_step(u), begin(extra blocks), add(...) for every element, then matrix and coupling() are ready.
/// Blocks may be added from several threads as long as no two calls at a time share a vertex.
class NewtonSystem {
public:
    NewtonSystem() = default;
    /// prescribed: one flag per unknown (3 per vertex). pairs: the vertex pairs that elements always couple.
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
        for (std::size_t j = 0; j < vertices.size(); ++j)
            for (std::size_t i = 0; i < vertices.size(); ++i)
                if (vertices[i] >= vertices[j])
                    add_block(vertices[i], vertices[j],
                              element.template block<3, 3>(3 * static_cast<int>(i), 3 * static_cast<int>(j)));
    }
    /// Adds block (i, j), i >= j, and by symmetry its transpose at (j, i).
    template <typename Derived>
    void add_block(int i, int j, const Eigen::MatrixBase<Derived>& block) {
        const int row = free_row_[static_cast<std::size_t>(i)];
        const int column = free_row_[static_cast<std::size_t>(j)];
        if (row >= 0 && column >= 0)
            values_of(row, column) += block;
        else
            add_prescribed_block(i, j, block);
    }

    /// Block (i, j) of the lower triangle, i >= j; both have rows and the pattern holds the block.
    Mat3 block(int i, int j) const;

    /// H u over all unknowns, 3 per vertex.
    const VecX& coupling() const { return coupling_; }

    /// Lower triangle in compressed columns of blocks: rows of column c are block_rows[column_starts[c] ...),
    /// ascending, the diagonal first. The value of scalar (3r+a, 3c+b) of the k-th block of column c with m blocks lies
    /// at values[9 * column_starts[c] + b * 3m + 3k + a]: that is the order of a scalar compressed-column matrix.
    const std::vector<int>& column_starts() const { return column_starts_; }
    const std::vector<int>& block_rows() const { return block_rows_; }
    const std::vector<double>& values() const { return values_; }
    int pattern_version() const { return pattern_version_; }

    /// Copies the free part of an n-vertex vector into rows and back (prescribed scalars read and write zero).
    VecX gather(const VecX& vertices) const;
    VecX scatter(const VecX& rows) const;

private:
    /// One or both of the vertices are prescribed in some axes.
    void add_prescribed_block(int i, int j, const Mat3& block);
    void reserve_pattern(std::span<const Edge> extra_pairs);
    std::vector<std::uint64_t> pattern_keys() const;
    void set_pattern(const std::vector<std::uint64_t>& keys);
    using Values = Eigen::Map<Mat3, 0, Eigen::OuterStride<>>;

    /// The block's number, counted without branches: columns are short, and a search would mispredict. -1 if none.
    int find_block(int row, int column) const {
        const int begin = column_starts_[static_cast<std::size_t>(column)];
        const int end = column_starts_[static_cast<std::size_t>(column) + 1];
        int found = begin;
        for (int k = begin; k < end; ++k)
            found += block_rows_[static_cast<std::size_t>(k)] < row;
        return found < end && block_rows_[static_cast<std::size_t>(found)] == row ? found : -1;
    }
    /// Where the block's first scalar lies in values(), and how far apart its columns are.
    std::pair<std::size_t, Eigen::OuterStride<>> place_of(int row, int column) const {
        const int begin = column_starts_[static_cast<std::size_t>(column)];
        const int end = column_starts_[static_cast<std::size_t>(column) + 1];
        const int k = find_block(row, column);
        assert(k >= 0 && "block outside the pattern: pass its pair to begin()");
        return {9 * static_cast<std::size_t>(begin) + 3 * static_cast<std::size_t>(k - begin),
                Eigen::OuterStride<>(3 * (end - begin))};
    }
    Values values_of(int row, int column) {
        const auto [start, stride] = place_of(row, column);
        return Values(values_.data() + start, stride);
    }

    std::vector<std::uint8_t> prescribed_;
    std::vector<int> row_of_vertex_; ///< -1 where all three axes are prescribed
    std::vector<int> free_row_;      ///< the same, also -1 where some are
    std::vector<int> vertex_of_row_;
    std::vector<std::uint8_t> partly_prescribed_; ///< per vertex
    std::vector<std::uint64_t> base_keys_;
    std::vector<int> column_starts_{0};
    std::vector<int> block_rows_;
    std::vector<double> values_;
    VecX prescribed_step_;
    VecX coupling_;
    int pattern_version_ = 0;
    std::size_t base_block_count_ = 0;
};

} // namespace plisse
