#pragma once

#include <array>
#include <vector>

#include <Eigen/SparseCore>

#include <plisse/geometry/polar.h>
#include <plisse/transfer/anchor.h>
#include <plisse/transfer/prolongation_operator.h>
#include <plisse/transfer/stencils.h>

namespace plisse {

/// One row for every fine vertex, one column for every coarse one.
using ProlongationWeights = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// Maps a coarse mesh's positions to a finer mesh. A fine vertex i anchored in coarse triangle T with corners k goes to
///     x_i = sum_k w_k x_k + sum_F R_F c_iF,
/// where R_F turns with coarse triangle F from its rest state, and the arms c_iF, fixed at rest, sum to the rest offset
/// o_i = rest_i - sum_k w_k rest_k. shell: c_iT = o_i alone. blend: c_iT = o_i / 2, and every triangle F around a
/// corner k adds its share a_F of the area there of w_k (rest_i - rest_k) / 2: between triangles at an angle the fine
/// surface bulges, as a bent shell does, where shell would crease it. intrinsic has no arms, nor has a linear operator,
/// whose weights w_k are given and reach beyond a triangle. A fine vertex without an anchor keeps its rest position.
class Prolongation {
public:
    Prolongation() = default;
    /// shell, intrinsic or blend. One anchor for every column of fine_rest.
    Prolongation(const Positions& coarse_rest, std::vector<Face> coarse_faces, std::vector<Anchor> anchors,
                 const Positions& fine_rest, ProlongationOperator kind = ProlongationOperator::shell);

    /// Linear, with these weights; a row of nothing stands for a fine vertex that keeps its rest position. Values are
    /// still pulled back by the anchors, whose weights are not negative.
    Prolongation(ProlongationWeights weights, const std::vector<Face>& coarse_faces, std::vector<Anchor> anchors,
                 const Positions& fine_rest);

    int coarse_count() const { return static_cast<int>(weights_.cols()); }
    int fine_count() const { return static_cast<int>(weights_.rows()); }
    const std::vector<Anchor>& anchors() const { return anchors_; }
    const Stencils& stencils() const { return stencils_; }

    Positions apply(const Positions& coarse) const;

    /// The Jacobian J of apply at `coarse`.
    ProlongationJacobian jacobian(const Positions& coarse) const;

    /// J^T g: the gradient with respect to the coarse positions.
    Positions pull_back(const Positions& coarse, const Positions& fine_gradient) const;

    /// U^T g: the same with the arms held constant (PSQ equation 10), and for values per vertex.
    Positions pull_back_lagged(const Positions& fine_gradient) const;
    VecX pull_back_values(const VecX& fine_values) const;

private:
    /// What a fine vertex carries along as a coarse face turns.
    struct Arm {
        int fine, face;
        double normal;            ///< along the face's normal, m
        Vec2 in_plane;            ///< along the axes of its rest frame, m
        std::array<int, 3> slots; ///< of the face's corners in the fine vertex's stencil
    };
    std::vector<int> turning_faces(int face, ProlongationOperator kind) const;
    void add_stencil(int face, const std::vector<int>& turning);
    void add_arms(int fine, const Vec3& rest, const Positions& coarse_rest, const std::vector<PolarFrame>& rest_frames,
                  const std::vector<int>& turning, const VecX& star_areas);
    double rest_area(int face) const;
    Mat32 deformation_gradient(int face, const Positions& coarse) const;
    std::vector<PolarFrame> frames(const Positions& coarse) const;
    Mat3 turned_gradient(int face, const Positions& coarse, const Positions& fine_gradient) const;

    std::vector<Anchor> anchors_;
    ProlongationWeights barycentric_; ///< of the anchors
    ProlongationWeights weights_;     ///< w; the same unless the operator is linear
    Positions unanchored_;            ///< rest positions of fine vertices without weights, zero elsewhere
    Stencils stencils_;
    std::vector<Face> coarse_faces_;
    std::vector<Mat2> rest_inverse_; ///< per coarse face: maps its edges to the rest frame (PSQ footnote 2)
    std::vector<Arm> arms_;          ///< by fine vertex
    std::vector<int> arm_starts_;
    std::vector<int> arms_of_face_, arms_of_face_starts_;
    std::vector<int> corners_of_vertex_, corner_starts_; ///< (3 face + corner) around each coarse vertex
};

} // namespace plisse
