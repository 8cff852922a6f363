#include <plisse/transfer/galerkin.h>

#include <algorithm>
#include <map>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

} // namespace

GalerkinProduct::GalerkinProduct(const Prolongation& prolongation, int element_count, const VerticesOf& vertices_of) {
    std::map<std::vector<int>, std::size_t> cluster_of;
    for (int e = 0; e < element_count; ++e) {
        Element element;
        element.number = e;
        std::vector<int> coarse;
        for (int v : vertices_of(e)) {
            element.fine[at(element.fine_count++)] = v;
            const Face& face = prolongation.coarse_faces()[at(prolongation.anchors()[at(v)].face)];
            coarse.insert(coarse.end(), face.begin(), face.end());
        }
        std::sort(coarse.begin(), coarse.end());
        coarse.erase(std::unique(coarse.begin(), coarse.end()), coarse.end());
        for (int a = 0; a < element.fine_count; ++a)
            for (std::size_t k = 0; k < 3; ++k) {
                const Face& face =
                    prolongation.coarse_faces()[at(prolongation.anchors()[at(element.fine[at(a)])].face)];
                const auto found = std::lower_bound(coarse.begin(), coarse.end(), face[k]);
                element.columns[at(a)][k] = static_cast<int>(found - coarse.begin());
            }
        const auto [entry, fresh] = cluster_of.try_emplace(coarse, clusters_.size());
        if (fresh)
            clusters_.push_back({coarse, {}});
        clusters_[entry->second].elements.push_back(element);
    }
    coloring_ = color_elements(static_cast<int>(clusters_.size()), prolongation.coarse_count(),
                               [&](int c) { return std::span<const int>(clusters_[at(c)].coarse); });
}

std::vector<Edge> GalerkinProduct::pairs() const {
    std::vector<Edge> result;
    for (const Cluster& cluster : clusters_)
        for (std::size_t i = 0; i < cluster.coarse.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                result.push_back({cluster.coarse[j], cluster.coarse[i]});
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

GalerkinProduct::ClusterMatrix GalerkinProduct::cluster_matrix(const Cluster& cluster,
                                                               const std::vector<Prolongation::Block>& jacobian,
                                                               const HessianOf& hessian_of) const {
    const int size = 3 * static_cast<int>(cluster.coarse.size());
    ClusterMatrix sum = ClusterMatrix::Zero(size, size);
    std::array<double, 9 * most_fine * most_fine> buffer;
    for (const Element& element : cluster.elements) {
        hessian_of(element.number, buffer.data());
        const int rows = 3 * element.fine_count;
        const Eigen::Map<const Eigen::MatrixXd> hessian(buffer.data(), rows, rows);
        for (int b = 0; b < element.fine_count; ++b)
            for (int a = 0; a < element.fine_count; ++a) {
                const Eigen::Matrix<double, 3, 9> right =
                    hessian.block<3, 3>(3 * a, 3 * b) * jacobian[at(element.fine[at(b)])];
                const Eigen::Matrix<double, 9, 9> product = jacobian[at(element.fine[at(a)])].transpose() * right;
                for (int j = 0; j < 3; ++j)
                    for (int i = 0; i < 3; ++i)
                        sum.block<3, 3>(3 * element.columns[at(a)][at(i)], 3 * element.columns[at(b)][at(j)]) +=
                            product.block<3, 3>(3 * i, 3 * j);
            }
    }
    return sum;
}

void GalerkinProduct::add(const std::vector<Prolongation::Block>& jacobian, const HessianOf& hessian_of,
                          NewtonSystem& system) const {
    for (std::size_t color = 0; color + 1 < coloring_.starts.size(); ++color) {
        const int begin = coloring_.starts[color];
        parallel_for(coloring_.starts[color + 1] - begin, 4, [&](int k) {
            const Cluster& cluster = clusters_[at(coloring_.order[at(begin + k)])];
            system.add(cluster.coarse, cluster_matrix(cluster, jacobian, hessian_of));
        });
    }
}

} // namespace plisse
