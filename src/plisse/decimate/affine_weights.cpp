#include <plisse/decimate/affine_weights.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include <Eigen/Eigenvalues>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Vertices of the coarse level and their weights, ascending.
using Row = std::vector<std::pair<int, double>>;

/// What each of the points weighs in the best affine map's image of another point. Directions in which the points do
/// not spread leave the map undetermined; there it moves nothing.
VecX best_fit_weights(const Positions& points, const Vec3& point) {
    constexpr double least_spread = 1e-10; // of the squared distances, against the largest
    const Vec3 mean = points.rowwise().mean();
    const Positions centred = points.colwise() - mean;
    const Eigen::SelfAdjointEigenSolver<Mat3> spread(centred * centred.transpose());
    const double smallest = least_spread * spread.eigenvalues()[2];
    Vec3 direction = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
        if (const double value = spread.eigenvalues()[k]; value > smallest)
            direction += spread.eigenvectors().col(k) * (spread.eigenvectors().col(k).dot(point - mean) / value);
    return (centred.transpose() * direction).array() + 1.0 / static_cast<double>(points.cols());
}

Row combined(const std::vector<Row>& rows, const std::vector<int>& vertices, const VecX& weights) {
    Row sum;
    for (std::size_t n = 0; n < vertices.size(); ++n)
        for (const auto& [column, weight] : rows[at(vertices[n])])
            sum.emplace_back(column, weights[static_cast<Eigen::Index>(n)] * weight);
    std::stable_sort(sum.begin(), sum.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    Row merged;
    for (const auto& [column, weight] : sum)
        if (!merged.empty() && merged.back().first == column)
            merged.back().second += weight;
        else
            merged.emplace_back(column, weight);
    return merged;
}

/// Rest positions of every vertex that ever was, by id.
Positions all_rest_positions(const Hierarchy& hierarchy) {
    const Positions& input = hierarchy.finest().rest;
    Positions rest(3, input.cols() + static_cast<Eigen::Index>(hierarchy.collapses.size()));
    rest.leftCols(input.cols()) = input;
    for (const Collapse& collapse : hierarchy.collapses)
        rest.col(collapse.k) = collapse.rest_k;
    return rest;
}

} // namespace

ProlongationWeights affine_weights(const Hierarchy& hierarchy, int from, int to) {
    assert(from <= to);
    const HierarchyLevel& coarse = hierarchy.levels[at(from)];
    const HierarchyLevel& fine = hierarchy.levels[at(to)];
    const Positions rest = all_rest_positions(hierarchy);
    std::vector<Row> rows(at(static_cast<int>(rest.cols())));
    for (std::size_t v = 0; v < coarse.vertex_ids.size(); ++v)
        rows[at(coarse.vertex_ids[v])] = {{static_cast<int>(v), 1.0}};
    const auto undo = [&](const Collapse& collapse) {
        std::vector<int> around = collapse.ring;
        around.push_back(collapse.k);
        Positions points(3, static_cast<Eigen::Index>(around.size()));
        for (std::size_t n = 0; n < around.size(); ++n)
            points.col(static_cast<Eigen::Index>(n)) = rest.col(around[n]);
        rows[at(collapse.i)] = combined(rows, around, best_fit_weights(points, collapse.rest_i));
        rows[at(collapse.j)] = combined(rows, around, best_fit_weights(points, collapse.rest_j));
        rows[at(collapse.k)].clear();
    };
    for (int l = from; l < to; ++l)
        for (const auto& batch : hierarchy.levels[at(l)].batches)
            for (int record : batch)
                undo(hierarchy.collapses[at(record)]);

    ProlongationWeights weights(fine.rest.cols(), coarse.rest.cols());
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t v = 0; v < fine.vertex_ids.size(); ++v)
        for (const auto& [column, weight] : rows[at(fine.vertex_ids[v])])
            entries.emplace_back(static_cast<int>(v), column, weight);
    weights.setFromTriplets(entries.begin(), entries.end());
    return weights;
}

} // namespace plisse
