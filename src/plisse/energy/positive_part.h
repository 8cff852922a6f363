#pragma once

#include <cmath>

#include <plisse/base/types.h>

namespace plisse {

/// The positive semi-definite matrix nearest to a symmetric 2x2 matrix: eigenvalues below zero become zero.
inline Mat2 positive_part(const Mat2& symmetric) {
    const double mean = (symmetric(0, 0) + symmetric(1, 1)) / 2;
    const double half_difference = (symmetric(0, 0) - symmetric(1, 1)) / 2;
    const double radius = std::sqrt(half_difference * half_difference + symmetric(0, 1) * symmetric(0, 1));
    const double low = mean - radius;
    const double high = mean + radius;
    if (low >= 0)
        return symmetric;
    if (high <= 0)
        return Mat2::Zero();
    return (symmetric - low * Mat2::Identity()) * (high / (high - low));
}

/// w with w w^T the positive part of a symmetric 2x2 matrix that has no two positive eigenvalues.
inline Vec2 positive_root(const Mat2& symmetric) {
    const Mat2 square = positive_part(symmetric);
    // From the larger diagonal entry: a root of the smaller one would keep half of its digits only.
    const int pivot = square(0, 0) >= square(1, 1) ? 0 : 1;
    const double root = std::sqrt(square(pivot, pivot));
    if (root == 0)
        return Vec2::Zero();
    return square.col(pivot) / root;
}

} // namespace plisse
