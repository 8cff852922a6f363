#pragma once

#include <array>
#include <vector>

#include <plisse/base/random.h>
#include <plisse/linalg/newton_system.h>
#include <plisse/linalg/scalar_transfer.h>

namespace plisse {

/// Uniform cubic B-splines over n faces a side, with their n + 3 control points a side: the tables between one grid and
/// the next finer one, in one dimension and as tensor products in two.
namespace spline {

using Triplets = std::vector<Eigen::Triplet<double>>;

inline ScalarTransfer table(int rows, int columns, const Triplets& entries) {
    ScalarTransfer result(rows, columns);
    result.setFromTriplets(entries.begin(), entries.end());
    return result;
}

/// Subdivision from n faces to 2n: (1, 4, 6, 4, 1)/8.
inline ScalarTransfer subdivision_1d(int n) {
    Triplets entries;
    for (int fine = 0; fine < 2 * n + 3; ++fine) {
        const int coarse = fine / 2; // control point i lies over the place i - 1
        if (fine % 2 == 1) {
            entries.emplace_back(fine, coarse, 0.125);
            entries.emplace_back(fine, coarse + 1, 0.75);
            entries.emplace_back(fine, coarse + 2, 0.125);
        } else {
            entries.emplace_back(fine, coarse, 0.5);
            entries.emplace_back(fine, coarse + 1, 0.5);
        }
    }
    return table(2 * n + 3, n + 3, entries);
}

/// Reverse subdivision: an inverse from the left.
inline ScalarTransfer projection_1d(int n) {
    Triplets entries;
    for (int coarse = 1; coarse < n + 2; ++coarse) {
        entries.emplace_back(coarse, 2 * coarse - 1, 2.0);
        entries.emplace_back(coarse, 2 * coarse - 2, -0.5);
        entries.emplace_back(coarse, 2 * coarse, -0.5);
    }
    for (const auto& [ghost, fine, inner] : {std::array{0, 0, 1}, std::array{n + 2, 2 * n + 2, 2 * n + 1}}) {
        entries.emplace_back(ghost, fine, 2.0); // twice the edge point less the inner vertex
        entries.emplace_back(ghost, inner, -2.0);
        entries.emplace_back(ghost, inner - 1, 0.5);
        entries.emplace_back(ghost, inner + 1, 0.5);
    }
    return table(n + 3, 2 * n + 3, entries);
}

/// Entry (i, j) of the grid has the number i + rows * j.
inline ScalarTransfer tensor(const ScalarTransfer& a) {
    const int rows = static_cast<int>(a.rows()), columns = static_cast<int>(a.cols());
    Triplets entries;
    for (int j = 0; j < columns; ++j)
        for (ScalarTransfer::InnerIterator v(a, j); v; ++v)
            for (int i = 0; i < columns; ++i)
                for (ScalarTransfer::InnerIterator u(a, i); u; ++u)
                    entries.emplace_back(static_cast<int>(u.row() + rows * v.row()), i + columns * j,
                                         u.value() * v.value());
    return table(rows * rows, columns * columns, entries);
}

/// Values and derivatives at t in [0, 1] of the four splines over a face of size h: value, first, second.
inline std::array<std::array<double, 4>, 3> basis(double t, double h) {
    const double s = 1 - t;
    return {{{s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6, t * t * t / 6},
             {-s * s / 2 / h, (9 * t * t - 12 * t) / 6 / h, -(9 * s * s - 12 * s) / 6 / h, t * t / 2 / h},
             {s / h / h, (3 * t - 2) / h / h, (3 * s - 2) / h / h, t / h / h}}};
}

/// Gauss rules on [0, 1], the second one exact for products of two splines.
inline constexpr std::array<double, 3> gauss_points = {0.1127016653792583, 0.5, 0.8872983346207417};
inline constexpr std::array<double, 3> gauss_weights = {5.0 / 18, 8.0 / 18, 5.0 / 18};
inline constexpr std::array<double, 4> fine_gauss_points = {0.06943184420297371, 0.33000947820757187,
                                                            0.6699905217924281, 0.9305681557970263};
inline constexpr std::array<double, 4> fine_gauss_weights = {0.17392742256872692, 0.32607257743127307,
                                                             0.32607257743127307, 0.17392742256872692};

inline std::vector<Edge> face_pairs(int n) {
    const auto vertex = [&](int i, int j) { return i + (n + 3) * j; };
    std::vector<Edge> pairs;
    for (int j = 0; j < n + 3; ++j)
        for (int i = 0; i < n + 3; ++i)
            for (int b = j; b <= std::min(j + 3, n + 2); ++b)
                for (int a = std::max(0, i - 3); a <= std::min(i + 3, n + 2); ++a)
                    if (vertex(a, b) >= vertex(i, j))
                        pairs.push_back({vertex(i, j), vertex(a, b)});
    return pairs;
}

/// The plate |u_xx|^2 + 2 |u_xy|^2 + |u_yy|^2 + shift |u|^2 on the unit square, its three unknowns coupled by a fixed
/// definite matrix.
inline NewtonSystem plate(int n, double shift) {
    const double h = 1.0 / n;
    Eigen::Matrix<double, 4, 4> k[3] = {Eigen::Matrix4d::Zero(), Eigen::Matrix4d::Zero(), Eigen::Matrix4d::Zero()};
    for (std::size_t q = 0; q < 4; ++q) {
        const auto values = basis(fine_gauss_points[q], h);
        for (std::size_t d = 0; d < 3; ++d) {
            const Eigen::Map<const Eigen::Vector4d> row(values[d].data());
            k[d] += fine_gauss_weights[q] * h * row * row.transpose();
        }
    }
    Mat3 coupling;
    coupling << 2, 0.5, 0, 0.5, 1, 0.2, 0, 0.2, 0.5;
    NewtonSystem system(std::vector<std::uint8_t>(3 * static_cast<std::size_t>((n + 3) * (n + 3)), 0), face_pairs(n));
    system.begin({});
    for (int fj = 0; fj < n; ++fj)
        for (int fi = 0; fi < n; ++fi)
            for (int p = 0; p < 16; ++p)
                for (int q = 0; q <= p; ++q) {
                    const int a = p % 4, b = p / 4, c = q % 4, d = q / 4;
                    const double bending =
                        k[2](a, c) * k[0](b, d) + 2 * k[1](a, c) * k[1](b, d) + k[0](a, c) * k[2](b, d);
                    const double entry = bending + shift * k[0](a, c) * k[0](b, d);
                    system.add_block(fi + a + (n + 3) * (fj + b), fi + c + (n + 3) * (fj + d), entry * coupling);
                }
    return system;
}

} // namespace spline

inline VecX random_vector(Eigen::Index size, std::uint64_t seed) {
    Random random(seed);
    VecX x(size);
    for (double& entry : x)
        entry = random.uniform(-1, 1);
    return x;
}

} // namespace plisse
