#pragma once

#include <memory>

#include <Eigen/SparseCholesky>

#include <plisse/subdivide/catmull_clark_step.h>

namespace plisse {

/// P: coarse control points from fine ones such that P S = I, each from its neighbourhood (RMTR section 5.3.2 and
/// appendices B and C). One row for every coarse vertex:
/// - a domain vertex of valence t != 3 from its own fine point and the edge and face points around it (5.21);
/// - one of valence 3, whose three say nothing of it, from its edges to neighbours that are known (B.2), the mean of
///   them: v = 4 e' - e - f1' - f2'. Where several such vertices are neighbours they follow from the outside inward;
/// - a ghost across an edge in the same way; one at a convex or re-entrant corner from the face point of the ghost face
///   there, v = 4 f' - the other three (B.4).
/// Throws InputError (with an empty place) for a component all of whose vertices have valence 3 (as a cube): there S
/// has no left inverse.
VertexWeights reverse_subdivision(const ControlMesh& coarse, const CatmullClarkStep& step);

/// The coarse control points nearest to fine ones: (S^T S)^-1 S^T (RMTR equation 5.18), by sparse Cholesky.
class LeastSquaresProjection {
public:
    explicit LeastSquaresProjection(VertexWeights subdivision);
    /// The same for other variables: with the maps from the fine ones to control points, and from the coarse control
    /// points.
    LeastSquaresProjection(VertexWeights subdivision, VertexWeights to_fine_points, VertexWeights from_coarse_points);

    /// One column for every coarse vertex from one for every fine one.
    Positions apply(const ConstPositions& fine) const;

private:
    VertexWeights subdivision_, to_fine_points_, from_coarse_points_;
    std::shared_ptr<const Eigen::SimplicialLLT<VertexWeights>> factor_; ///< shared, as it cannot be copied
};

} // namespace plisse
