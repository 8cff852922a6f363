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

std::vector<int> united(const Face& a, const Face& b) {
    std::vector<int> vertices(a.begin(), a.end());
    vertices.insert(vertices.end(), b.begin(), b.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

} // namespace

GalerkinProduct::GalerkinProduct(const Prolongation& prolongation, std::span<const Edge> pairs) {
    const auto face_of = [&](int vertex) { return prolongation.anchors()[at(vertex)].face; };
    std::map<std::pair<int, int>, std::size_t> cluster_of;
    for (const auto& [column, row] : with_diagonal(pairs)) {
        const bool transposed = face_of(row) > face_of(column);
        const int left = transposed ? column : row, right = transposed ? row : column;
        const auto [entry, fresh] = cluster_of.try_emplace({face_of(left), face_of(right)}, clusters_.size());
        if (fresh) {
            const Face& left_face = prolongation.coarse_faces()[at(face_of(left))];
            const Face& right_face = prolongation.coarse_faces()[at(face_of(right))];
            clusters_.push_back({left_face, right_face, united(left_face, right_face), {}, 0, {}});
        }
        clusters_[entry->second].blocks.push_back({left, right, transposed});
    }
    for (Cluster& cluster : clusters_) {
        std::stable_sort(cluster.blocks.begin(), cluster.blocks.end(),
                         [](const Block& a, const Block& b) { return a.right < b.right; });
        cluster.first_pair = fine_pairs_.size();
        for (const Block& block : cluster.blocks)
            fine_pairs_.push_back({std::min(block.left, block.right), std::max(block.left, block.right)});
    }
    coloring_ = color_elements(static_cast<int>(clusters_.size()), prolongation.coarse_count(),
                               [&](int c) { return std::span<const int>(clusters_[at(c)].vertices); });
}

std::vector<Edge> GalerkinProduct::pairs() const {
    std::vector<Edge> result;
    for (const Cluster& cluster : clusters_)
        for (int l : cluster.left)
            for (int r : cluster.right)
                if (l != r)
                    result.push_back({std::min(l, r), std::max(l, r)});
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

void GalerkinProduct::place_in(const NewtonSystem& coarse) {
    for (Cluster& cluster : clusters_)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t i = 0; i < 3; ++i) {
                const auto [lower, upper] = std::minmax(cluster.left[i], cluster.right[j]);
                cluster.numbers[3 * j + i] = coarse.base_block(upper, lower);
            }
}

/// One half of what the cluster adds: the other is its transpose. The products are spelled out as sums of columns of
/// nine, which are contiguous; Eigen's go entry by entry.
GalerkinProduct::FacePair GalerkinProduct::sum_blocks(const Cluster& cluster,
                                                      const std::vector<Prolongation::Block>& jacobian,
                                                      const std::vector<Mat3>& fine) {
    FacePair sum = FacePair::Zero();
    auto value = fine.begin() + static_cast<std::ptrdiff_t>(cluster.first_pair);
    for (auto block = cluster.blocks.begin(); block != cluster.blocks.end();) {
        const int right = block->right;
        Eigen::Matrix<double, 9, 3> carried = Eigen::Matrix<double, 9, 3>::Zero();
        for (; block != cluster.blocks.end() && block->right == right; ++block) {
            Mat3 h = *value++;
            if (block->transposed)
                h.transposeInPlace();
            if (block->left == right)
                h *= 0.5;
            const Prolongation::Block& left = jacobian[at(block->left)];
            for (int c = 0; c < 3; ++c)
                for (int k = 0; k < 3; ++k)
                    carried.col(c) += h(k, c) * left.row(k).transpose();
        }
        for (int c = 0; c < 9; ++c)
            for (int k = 0; k < 3; ++k)
                sum.col(c) += jacobian[at(right)](k, c) * carried.col(k);
    }
    return sum;
}

void GalerkinProduct::add_symmetric(const Cluster& cluster, const FacePair& sum, NewtonSystem& coarse) {
    for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 3; ++i) {
            const int left = cluster.left[i], right = cluster.right[j], number = cluster.numbers[3 * j + i];
            const Mat3 block = sum.block<3, 3>(3 * static_cast<int>(i), 3 * static_cast<int>(j));
            if (left == right)
                coarse.add_block_at(number, left, left, block + block.transpose());
            else if (left > right)
                coarse.add_block_at(number, left, right, block);
            else
                coarse.add_block_at(number, right, left, block.transpose());
        }
}

void GalerkinProduct::add(const std::vector<Prolongation::Block>& jacobian, const NewtonSystem& fine,
                          NewtonSystem& coarse) const {
    for (int color = 0; color < coloring_.color_count(); ++color) {
        const std::span<const int> members = coloring_.elements(color);
        parallel_for(static_cast<int>(members.size()), 8, [&](int k) {
            const Cluster& cluster = clusters_[at(members[at(k)])];
            add_symmetric(cluster, sum_blocks(cluster, jacobian, fine.blocks()), coarse);
        });
    }
}

} // namespace plisse
