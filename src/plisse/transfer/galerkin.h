#pragma once

#include <span>
#include <vector>

#include <plisse/linalg/coloring.h>
#include <plisse/linalg/newton_system.h>
#include <plisse/transfer/prolongation.h>

namespace plisse {

/// J^T H J for a fine Hessian H in blocks, J being a prolongation's Jacobian, which is never formed. Every block of H
/// is multiplied once, and blocks that reach the same coarse vertices are summed before they are scattered: several
/// times cheaper than element by element, because elements share blocks.
class GalerkinProduct {
public:
    GalerkinProduct() = default;
    /// pairs: the fine vertex pairs that H couples, lower first; all of their vertices have anchors.
    GalerkinProduct(const Prolongation& prolongation, std::span<const Edge> pairs);

    /// Coarse vertex pairs the product couples.
    std::vector<Edge> pairs() const;

    /// Adds the product to a system over the coarse vertices. jacobian: Prolongation::jacobian at the current
    /// positions. fine: H over the fine vertices, none prescribed.
    void add(const std::vector<Prolongation::Block>& jacobian, const NewtonSystem& fine, NewtonSystem& coarse) const;

private:
    static constexpr int most_coarse = 6;
    struct Block {
        int row, column;                      ///< fine vertices, row >= column
        std::array<int, 3> row_at, column_at; ///< places of their anchors' corners in the cluster
    };
    struct Cluster {
        std::vector<int> coarse;
        std::vector<Block> blocks;
    };
    using ClusterMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * most_coarse, 3 * most_coarse>;
    static ClusterMatrix cluster_matrix(const Cluster& cluster, const std::vector<Prolongation::Block>& jacobian,
                                        const NewtonSystem& fine);

    std::vector<Cluster> clusters_;
    Coloring coloring_;
};

} // namespace plisse
