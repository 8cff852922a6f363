#pragma once

#include <span>

#include <plisse/geometry/distance.h>

namespace plisse {

/// A function of a few squared distances D_a of one stencil, by its derivatives there.
struct DistanceFunction {
    static constexpr int most = 5;

    explicit DistanceFunction(int count)
        : first(Eigen::VectorXd::Zero(count)), second(Eigen::MatrixXd::Zero(count, count)) {}

    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most, 1> first;                  ///< f_a = df/dD_a
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most> second; ///< f_ab = d2f/dD_a dD_b
};

/// df/dX in the order of the stencil: sum_a f_a dD_a/dX. separations: of each D_a.
Vec12 gradient(const DistanceFunction& f, std::span<const Separation> separations);

/// d2f/dX2 = sum_a f_a d2D_a/dX2 + sum_ab f_ab dD_a/dX dD_b/dX^T, while the closest features stay the same.
Mat12 hessian(const DistanceFunction& f, std::span<const Separation> separations);

/// A positive semi-definite matrix not below d2f/dX2 and close to it, by eigenvalues of nothing larger than f_ab. With
/// orthonormal tangents t_k, slides v_k, weights w, unit offset n and distance d = sqrt(D_a) (x is Kronecker's product)
///   f_a d2D_a/dX2 = 2 f_a [(w x n)(w x n)^T + sum_m (w x m)(w x m)^T
///                          - sum_k (d (w x t_k)(v_k x n)^T + its transpose + d^2 (v_k x n)(v_k x n)^T)]
/// with the directions m across n and the tangents. The first term, along dD_a/dX, joins the second derivatives, which
/// are projected in the span of the gradients. The second is positive or not as f_a is, and each of the third is a 2x2
/// matrix.
Mat12 projected_hessian(const DistanceFunction& f, std::span<const Separation> separations);

} // namespace plisse
