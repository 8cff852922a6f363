#pragma once

#include <array>
#include <span>
#include <vector>

#include <plisse/linalg/coloring.h>
#include <plisse/linalg/newton_system.h>
#include <plisse/transfer/prolongation.h>

namespace plisse {

/// J^T H J for a fine Hessian H in blocks, J being a prolongation's Jacobian, which is never formed. The blocks of H
/// that couple the same two coarse faces are multiplied from one side, summed over what they share, multiplied from the
/// other side, summed, and added to the coarse system: several times cheaper than element by element.
class GalerkinProduct {
public:
    GalerkinProduct() = default;
    /// pairs: the fine vertex pairs that H couples, lower first; all of their vertices have anchors.
    GalerkinProduct(const Prolongation& prolongation, std::span<const Edge> pairs);

    /// The pairs and the diagonal in the order in which H is read.
    const std::vector<Edge>& fine_pairs() const { return fine_pairs_; }

    /// Coarse vertex pairs the product couples.
    std::vector<Edge> pairs() const;

    /// Finds where the product's blocks go in a system over the coarse vertices, which was made with pairs().
    void place_in(const NewtonSystem& coarse);

    /// Adds the product to the system of place_in. jacobian: Prolongation::jacobian at the current positions. fine: H,
    /// in a system made with fine_pairs(), none of its unknowns prescribed.
    void add(const std::vector<Prolongation::Block>& jacobian, const NewtonSystem& fine, NewtonSystem& coarse) const;

private:
    /// A block of H, its rows in the left face of its cluster and its columns in the right one.
    struct Block {
        int left, right; ///< fine vertices
        bool transposed; ///< H holds it with rows and columns exchanged
    };
    /// Two coarse faces and the blocks between them, sorted by their right vertices.
    struct Cluster {
        Face left, right;
        std::vector<int> vertices; ///< of both
        std::vector<Block> blocks;
        std::size_t first_pair;     ///< in fine_pairs, of the blocks
        std::array<int, 9> numbers; ///< in the coarse system, of left corner i and right corner j at 3 j + i
    };
    using FacePair = Eigen::Matrix<double, 9, 9>;
    static FacePair sum_blocks(const Cluster& cluster, const std::vector<Prolongation::Block>& jacobian,
                               const std::vector<Mat3>& fine);
    static void add_symmetric(const Cluster& cluster, const FacePair& sum, NewtonSystem& coarse);

    std::vector<Cluster> clusters_;
    std::vector<Edge> fine_pairs_;
    Coloring coloring_;
};

} // namespace plisse
