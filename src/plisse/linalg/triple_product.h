#pragma once

#include <vector>

#include <plisse/linalg/newton_system.h>
#include <plisse/linalg/scalar_transfer.h>

namespace plisse {

/// S' H S for a matrix H in 3x3 blocks and a scalar table S, column of blocks by column of blocks, so that only H and
/// the product are ever stored. The pattern of the product is found once for each pattern of H. All unknowns are free.
class TripleProduct {
public:
    /// s is kept by reference.
    explicit TripleProduct(const ScalarTransfer& s);

    /// The product, which lives until the next call.
    const NewtonSystem& compute(const NewtonSystem& fine);

private:
    struct Entry {
        int row;
        int number; ///< in NewtonSystem::blocks
        bool transposed;
    };
    struct Workspace {
        std::vector<int> place_of_fine, place_of_coarse; ///< -1 where not in use
        std::vector<int> touched;                        ///< fine vertices that a coarse column reaches through H
        std::vector<Mat3> carried;                       ///< (H S) at those
    };

    void find_pattern(const NewtonSystem& fine);
    std::vector<int> coarse_rows(int column, Workspace& workspace) const;
    void touch(int column, Workspace& workspace) const;
    void release(Workspace& workspace) const;
    void add_column(int column, const NewtonSystem& fine, Workspace& workspace);
    Workspace workspace() const;

    const ScalarTransfer& s_;
    Eigen::SparseMatrix<double, Eigen::RowMajor> rows_; ///< of S
    std::vector<std::size_t> entry_starts_;             ///< of the whole columns of H, both triangles
    std::vector<Entry> entries_;
    NewtonSystem coarse_;
    std::vector<Edge> extra_pairs_; ///< that later patterns of H bring
    int pattern_version_ = -1;
};

} // namespace plisse
