#include <plisse/transfer/galerkin.h>

#include <algorithm>
#include <map>
#include <utility>

#include <plisse/base/parallel.h>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

std::vector<Edge> with_diagonal(std::span<const Edge> pairs) {
    std::vector<Edge> all(pairs.begin(), pairs.end());
    for (const Edge& pair : pairs) {
        all.push_back({pair[0], pair[0]});
        all.push_back({pair[1], pair[1]});
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

std::vector<int> united(std::span<const int> a, std::span<const int> b) {
    std::vector<int> vertices(a.begin(), a.end());
    vertices.insert(vertices.end(), b.begin(), b.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

} // namespace

GalerkinProduct::GalerkinProduct(Stencils stencils, int coarse_count, std::span<const Edge> pairs)
    : stencils_(std::move(stencils)) {
    const auto group_of = [&](int vertex) { return stencils_.group_of[at(vertex)]; };
    std::map<std::pair<int, int>, std::size_t> cluster_of;
    for (const auto& [column, row] : with_diagonal(pairs)) {
        const bool transposed = group_of(row) > group_of(column);
        const int left = transposed ? column : row, right = transposed ? row : column;
        const auto [entry, fresh] = cluster_of.try_emplace({group_of(left), group_of(right)}, clusters_.size());
        if (fresh)
            clusters_.push_back(
                {group_of(left), group_of(right), united(stencils_.of(left), stencils_.of(right)), {}, 0, {}});
        clusters_[entry->second].blocks.push_back({left, right, transposed});
    }
    for (Cluster& cluster : clusters_) {
        std::stable_sort(cluster.blocks.begin(), cluster.blocks.end(),
                         [](const Block& a, const Block& b) { return a.right < b.right; });
        cluster.first_pair = fine_pairs_.size();
        for (const Block& block : cluster.blocks)
            fine_pairs_.push_back({std::min(block.left, block.right), std::max(block.left, block.right)});
    }
    coloring_ = color_elements(static_cast<int>(clusters_.size()), coarse_count,
                               [&](int c) { return std::span<const int>(clusters_[at(c)].vertices); });
}

std::vector<Edge> GalerkinProduct::pairs() const {
    std::vector<Edge> result;
    for (const Cluster& cluster : clusters_)
        for (int l : stencils_.group(cluster.left))
            for (int r : stencils_.group(cluster.right))
                if (l != r)
                    result.push_back({std::min(l, r), std::max(l, r)});
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

void GalerkinProduct::place_in(const NewtonSystem& coarse) {
    for (Cluster& cluster : clusters_) {
        cluster.numbers.clear();
        for (int right : stencils_.group(cluster.right))
            for (int left : stencils_.group(cluster.left)) {
                const auto [lower, upper] = std::minmax(left, right);
                cluster.numbers.push_back(coarse.base_block(upper, lower));
            }
    }
}

/// One half of what the cluster adds: the other is its transpose. The products are spelled out as sums of columns,
/// which are contiguous; Eigen's go entry by entry.
template <int columns>
GalerkinProduct::GroupPair<columns> GalerkinProduct::sum_blocks(const Cluster& cluster,
                                                                const ProlongationJacobian& jacobian,
                                                                const std::vector<Mat3>& fine) const {
    const auto height = static_cast<Eigen::Index>(3 * stencils_.group(cluster.left).size());
    const auto width = static_cast<Eigen::Index>(3 * stencils_.group(cluster.right).size());
    GroupPair<columns> sum = GroupPair<columns>::Zero(height, width);
    Eigen::Matrix<double, columns, 3> carried(height, 3);
    auto value = fine.begin() + static_cast<std::ptrdiff_t>(cluster.first_pair);
    for (auto block = cluster.blocks.begin(); block != cluster.blocks.end();) {
        const int right = block->right;
        carried.setZero();
        for (; block != cluster.blocks.end() && block->right == right; ++block) {
            Mat3 h = *value++;
            if (block->transposed)
                h.transposeInPlace();
            if (block->left == right)
                h *= 0.5;
            const auto left = jacobian.rows<columns>(block->left);
            for (int c = 0; c < 3; ++c)
                for (int k = 0; k < 3; ++k)
                    carried.col(c) += h(k, c) * left.row(k).transpose();
        }
        const auto rows = jacobian.rows<columns>(right);
        for (Eigen::Index c = 0; c < width; ++c)
            for (int k = 0; k < 3; ++k)
                sum.col(c) += rows(k, c) * carried.col(k);
    }
    return sum;
}

template <typename Sum>
void GalerkinProduct::add_symmetric(const Cluster& cluster, const Sum& sum, NewtonSystem& coarse) const {
    const auto lefts = stencils_.group(cluster.left), rights = stencils_.group(cluster.right);
    auto number = cluster.numbers.begin();
    for (std::size_t j = 0; j < rights.size(); ++j)
        for (std::size_t i = 0; i < lefts.size(); ++i, ++number) {
            const int left = lefts[i], right = rights[j];
            const Mat3 block = sum.template block<3, 3>(3 * static_cast<int>(i), 3 * static_cast<int>(j));
            if (left == right)
                coarse.add_block_at(*number, left, left, block + block.transpose());
            else if (left > right)
                coarse.add_block_at(*number, left, right, block);
            else
                coarse.add_block_at(*number, right, left, block.transpose());
        }
}

void GalerkinProduct::add(const ProlongationJacobian& jacobian, const NewtonSystem& fine, NewtonSystem& coarse) const {
    const auto add_cluster = [&](const Cluster& cluster) {
        constexpr int face = 9; // by far the commonest, and twice as fast with its size known beforehand
        if (stencils_.group(cluster.left).size() == 3 && stencils_.group(cluster.right).size() == 3)
            add_symmetric(cluster, sum_blocks<face>(cluster, jacobian, fine.blocks()), coarse);
        else
            add_symmetric(cluster, sum_blocks<Eigen::Dynamic>(cluster, jacobian, fine.blocks()), coarse);
    };
    for (int color = 0; color < coloring_.color_count(); ++color) {
        const std::span<const int> members = coloring_.elements(color);
        parallel_for(static_cast<int>(members.size()), 8, [&](int k) { add_cluster(clusters_[at(members[at(k)])]); });
    }
}

} // namespace plisse
