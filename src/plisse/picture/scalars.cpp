#include <plisse/picture/scalars.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <plisse/mesh/connectivity.h>

namespace plisse {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Edges of a triangle as the columns of a 2x2 matrix, in a frame of its own plane.
Mat2 flattened(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = b - a;
    const Vec3 v = c - a;
    const double length = u.norm();
    Mat2 edges;
    edges << length, u.dot(v) / length, 0, u.cross(v).norm() / length;
    return edges;
}

/// Shares of a triangle's area that belong to its corners (Meyer et al. 2003, section 3.3).
Vec3 mixed_areas(const Vec3& cotangents, const Vec3& squared_lengths, double area) {
    for (int k = 0; k < 3; ++k)
        if (cotangents[k] < 0) {
            Vec3 shares = Vec3::Constant(area / 4);
            shares[k] = area / 2;
            return shares;
        }
    Vec3 shares;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3;
        const int j = (k + 2) % 3;
        shares[k] = (cotangents[i] * squared_lengths[i] + cotangents[j] * squared_lengths[j]) / 8;
    }
    return shares;
}

/// Gives the vertices at the borders of sheets the mean of their inner neighbours, and those without any, such as the
/// corners of a sheet, the mean of the neighbours that got one.
void fill_boundary(std::vector<double>& values, const Connectivity& mesh) {
    for (int e = 0; e < mesh.edge_count(); ++e)
        if (mesh.is_curve_edge(e))
            for (int v : mesh.edges()[static_cast<std::size_t>(e)])
                values[static_cast<std::size_t>(v)] = nan;
    for (int round = 0; round < 2; ++round) {
        std::vector<double> sum(values.size(), 0.0);
        std::vector<int> count(values.size(), 0);
        for (const Edge& edge : mesh.edges())
            for (std::size_t side = 0; side < 2; ++side) {
                const auto v = static_cast<std::size_t>(edge[side]);
                const double other = values[static_cast<std::size_t>(edge[1 - side])];
                if (std::isnan(values[v]) && !std::isnan(other)) {
                    sum[v] += other;
                    ++count[v];
                }
            }
        for (std::size_t v = 0; v < values.size(); ++v)
            if (count[v] > 0)
                values[v] = sum[v] / count[v];
    }
}

} // namespace

void fit_range(Scalars& scalars, const std::vector<bool>& counts, double cut) {
    assert(counts.empty() || counts.size() == scalars.values.size());
    std::vector<double> seen;
    for (std::size_t i = 0; i < scalars.values.size(); ++i)
        if (std::isfinite(scalars.values[i]) && (counts.empty() || counts[i]))
            seen.push_back(scalars.values[i]);
    if (seen.empty())
        seen = {0, 1};
    std::sort(seen.begin(), seen.end());
    scalars.low = seen.front();
    scalars.high = seen[static_cast<std::size_t>((1 - cut) * static_cast<double>(seen.size() - 1))];
    // Round-off is not worth a rainbow.
    const double least = 1e-6 * std::max(std::abs(scalars.low), std::abs(scalars.high)) + 1e-12;
    if (scalars.high - scalars.low < least)
        scalars.high = scalars.low + least;
}

std::vector<double> largest_stretches(const ConstPositions& rest, const ConstPositions& positions,
                                      std::span<const Face> faces) {
    assert(rest.cols() == positions.cols());
    std::vector<double> stretches;
    stretches.reserve(faces.size());
    for (const auto& [a, b, c] : faces) {
        const Mat2 rest_edges = flattened(rest.col(a), rest.col(b), rest.col(c));
        if (!(rest_edges.determinant() > 0)) {
            stretches.push_back(nan);
            continue;
        }
        const Mat2 f = flattened(positions.col(a), positions.col(b), positions.col(c)) * rest_edges.inverse();
        const double mean = 0.5 * f.squaredNorm();
        const double squared = mean + std::sqrt(std::max(0.0, mean * mean - std::pow(f.determinant(), 2)));
        stretches.push_back(std::sqrt(squared));
    }
    return stretches;
}

std::vector<double> mean_curvatures(const ConstPositions& positions, std::span<const Face> faces) {
    const auto count = static_cast<std::size_t>(positions.cols());
    Positions laplacian = Positions::Zero(3, positions.cols());
    std::vector<double> areas(count, 0.0);
    for (const Face& face : faces) {
        std::array<Vec3, 3> edge; // opposite each corner
        Vec3 cotangents, squared_lengths;
        for (std::size_t k = 0; k < 3; ++k)
            edge[k] = positions.col(face[(k + 2) % 3]) - positions.col(face[(k + 1) % 3]);
        const double twice_area = edge[0].cross(edge[1]).norm();
        if (!(twice_area > 0))
            continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto row = static_cast<Eigen::Index>(k);
            cotangents[row] = -edge[(k + 1) % 3].dot(edge[(k + 2) % 3]) / twice_area;
            squared_lengths[row] = edge[k].squaredNorm();
        }
        const Vec3 shares = mixed_areas(cotangents, squared_lengths, 0.5 * twice_area);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 pull = cotangents[static_cast<Eigen::Index>(k)] * edge[k];
            laplacian.col(face[(k + 1) % 3]) += pull;
            laplacian.col(face[(k + 2) % 3]) -= pull;
            areas[static_cast<std::size_t>(face[k])] += shares[static_cast<Eigen::Index>(k)];
        }
    }
    std::vector<double> curvatures(count, nan);
    for (std::size_t v = 0; v < count; ++v)
        if (areas[v] > 0)
            curvatures[v] = laplacian.col(static_cast<Eigen::Index>(v)).norm() / (4 * areas[v]);
    fill_boundary(curvatures, Connectivity(static_cast<int>(count), faces));
    return curvatures;
}

} // namespace plisse
