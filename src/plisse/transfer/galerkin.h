#pragma once

#include <span>
#include <vector>

#include <plisse/linalg/coloring.h>
#include <plisse/linalg/newton_system.h>
#include <plisse/transfer/stencils.h>

namespace plisse {

/// J^T H J for a fine Hessian H in blocks, J being a prolongation's Jacobian, which is never formed. The blocks of H
/// that couple the same two groups of stencils are multiplied from one side, summed over what they share, multiplied
/// from the other side, summed, and added to the coarse system: several times cheaper than element by element.
class GalerkinProduct {
public:
    GalerkinProduct() = default;
    /// pairs: the fine vertex pairs that H couples, lower first; all of their vertices have stencils.
    GalerkinProduct(Stencils stencils, int coarse_count, std::span<const Edge> pairs);

    /// The pairs and the diagonal in the order in which H is read.
    const std::vector<Edge>& fine_pairs() const { return fine_pairs_; }

    /// Coarse vertex pairs the product couples.
    std::vector<Edge> pairs() const;

    /// Finds where the product's blocks go in a system over the coarse vertices, which was made with pairs().
    void place_in(const NewtonSystem& coarse);

    /// Adds the product to the system of place_in. jacobian: Prolongation::jacobian at the current positions. fine: H,
    /// in a system made with fine_pairs(), none of its unknowns prescribed.
    void add(const ProlongationJacobian& jacobian, const NewtonSystem& fine, NewtonSystem& coarse) const;

private:
    /// A block of H, its rows in the left group of its cluster and its columns in the right one.
    struct Block {
        int left, right; ///< fine vertices
        bool transposed; ///< H holds it with rows and columns exchanged
    };
    /// Two groups of stencils and the blocks between them, sorted by their right vertices.
    struct Cluster {
        int left, right;
        std::vector<int> vertices; ///< of both stencils
        std::vector<Block> blocks;
        std::size_t first_pair;   ///< in fine_pairs, of the blocks
        std::vector<int> numbers; ///< in the coarse system, of left vertex i and right vertex j, column by column
    };
    template <int columns>
    using GroupPair = Eigen::Matrix<double, columns, columns>;
    template <int columns>
    GroupPair<columns> sum_blocks(const Cluster& cluster, const ProlongationJacobian& jacobian,
                                  const std::vector<Mat3>& fine) const;
    template <typename Sum>
    void add_symmetric(const Cluster& cluster, const Sum& sum, NewtonSystem& coarse) const;

    Stencils stencils_;
    std::vector<Cluster> clusters_;
    std::vector<Edge> fine_pairs_;
    Coloring coloring_;
};

} // namespace plisse
