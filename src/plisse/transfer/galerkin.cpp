#include <plisse/transfer/galerkin.h>

#include <algorithm>
#include <map>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

const Face& anchor_face(const Prolongation& prolongation, int fine) {
    return prolongation.coarse_faces()[at(prolongation.anchors()[at(fine)].face)];
}

std::array<int, 3> places(const Face& face, const std::vector<int>& coarse) {
    std::array<int, 3> result;
    for (std::size_t k = 0; k < 3; ++k)
        result[k] = static_cast<int>(std::lower_bound(coarse.begin(), coarse.end(), face[k]) - coarse.begin());
    return result;
}

std::vector<int> united(const Face& a, const Face& b) {
    std::vector<int> vertices(a.begin(), a.end());
    vertices.insert(vertices.end(), b.begin(), b.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

} // namespace

GalerkinProduct::GalerkinProduct(const Prolongation& prolongation, std::span<const Edge> pairs) {
    std::vector<Edge> all(pairs.begin(), pairs.end());
    for (const Edge& pair : pairs) {
        all.push_back({pair[0], pair[0]});
        all.push_back({pair[1], pair[1]});
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());

    std::map<std::vector<int>, std::size_t> cluster_of;
    for (const auto& [column, row] : all) {
        const Face& row_face = anchor_face(prolongation, row);
        const Face& column_face = anchor_face(prolongation, column);
        std::vector<int> coarse = united(row_face, column_face);
        const auto [entry, fresh] = cluster_of.try_emplace(coarse, clusters_.size());
        if (fresh)
            clusters_.push_back({coarse, {}});
        clusters_[entry->second].blocks.push_back({row, column, places(row_face, coarse), places(column_face, coarse)});
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

// lazyProduct: products of this size must not take the way of large matrices, which costs more than they do.
GalerkinProduct::ClusterMatrix GalerkinProduct::cluster_matrix(const Cluster& cluster,
                                                               const std::vector<Prolongation::Block>& jacobian,
                                                               const NewtonSystem& fine) {
    const int size = 3 * static_cast<int>(cluster.coarse.size());
    ClusterMatrix sum = ClusterMatrix::Zero(size, size);
    for (const Block& block : cluster.blocks) {
        const Mat3 h = fine.block(block.row, block.column);
        const Prolongation::Block carried = h.lazyProduct(jacobian[at(block.column)]);
        const Prolongation::Block& left = jacobian[at(block.row)];
        for (int i = 0; i < 3; ++i) {
            const Prolongation::Block row = left.middleCols<3>(3 * i).transpose().lazyProduct(carried);
            for (int j = 0; j < 3; ++j) {
                const int r = 3 * block.row_at[at(i)], c = 3 * block.column_at[at(j)];
                sum.block<3, 3>(r, c) += row.middleCols<3>(3 * j);
                if (block.row != block.column)
                    sum.block<3, 3>(c, r) += row.middleCols<3>(3 * j).transpose();
            }
        }
    }
    return sum;
}

void GalerkinProduct::add(const std::vector<Prolongation::Block>& jacobian, const NewtonSystem& fine,
                          NewtonSystem& coarse) const {
    for (int color = 0; color < coloring_.color_count(); ++color) {
        const std::span<const int> members = coloring_.elements(color);
        parallel_for(static_cast<int>(members.size()), 8, [&](int k) {
            const Cluster& cluster = clusters_[at(members[at(k)])];
            coarse.add(cluster.coarse, cluster_matrix(cluster, jacobian, fine));
        });
    }
}

} // namespace plisse
