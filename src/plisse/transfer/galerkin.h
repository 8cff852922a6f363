#pragma once

#include <functional>
#include <span>
#include <vector>

#include <plisse/linalg/coloring.h>
#include <plisse/linalg/newton_system.h>
#include <plisse/transfer/prolongation.h>

namespace plisse {

/// J^T H J for a fine Hessian H that is a sum over elements of at most four vertices, J being a prolongation's
/// Jacobian; neither matrix is ever formed. Elements that reach the same coarse vertices are summed before they are
/// scattered.
class GalerkinProduct {
public:
    using VerticesOf = std::function<std::span<const int>(int element)>;
    /// Writes an element's Hessian, 3k x 3k, column-major.
    using HessianOf = std::function<void(int element, double* hessian)>;

    GalerkinProduct(const Prolongation& prolongation, int element_count, const VerticesOf& vertices_of);

    /// Coarse vertex pairs the product couples.
    std::vector<Edge> pairs() const;

    /// Adds the product to the system. jacobian: Prolongation::jacobian at the current positions.
    void add(const std::vector<Prolongation::Block>& jacobian, const HessianOf& hessian_of, NewtonSystem& system) const;

private:
    static constexpr int most_fine = 4;
    static constexpr int most_coarse = 3 * most_fine;
    struct Element {
        int number = 0;
        int fine_count = 0;
        std::array<int, most_fine> fine{};
        std::array<std::array<int, 3>, most_fine> columns{}; ///< of each fine vertex's corners, in the cluster
    };
    struct Cluster {
        std::vector<int> coarse;
        std::vector<Element> elements;
    };
    using ClusterMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * most_coarse, 3 * most_coarse>;
    ClusterMatrix cluster_matrix(const Cluster& cluster, const std::vector<Prolongation::Block>& jacobian,
                                 const HessianOf& hessian_of) const;

    std::vector<Cluster> clusters_;
    Coloring coloring_;
};

} // namespace plisse
