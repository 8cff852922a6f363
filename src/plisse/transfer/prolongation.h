#pragma once

#include <span>
#include <vector>

#include <plisse/geometry/polar.h>
#include <plisse/transfer/anchor.h>

namespace plisse {

enum class ProlongationOperator {
    shell,    ///< anchors plus offsets that turn with the coarse triangle (PSQ equations 4-9)
    intrinsic ///< anchors alone (Liu et al. 2021): loses the rest shape
};

/// Maps a coarse mesh's positions to a finer mesh: fine vertex i in coarse triangle (a, b, c) goes to
///     x_i = w_a a + w_b b + w_c c + n gamma_i + R t_i,
/// where (gamma_i, t_i) is the rest difference in the triangle's rest frame and n, R are the deformed triangle's normal
/// and rotation. A fine vertex without an anchor keeps its rest position.
class Prolongation {
public:
    /// d x_i / d (a, b, c), columns in the order of the coarse face's corners.
    using Block = Eigen::Matrix<double, 3, 9, Eigen::RowMajor>;

    Prolongation() = default;
    /// One anchor for every column of fine_rest.
    Prolongation(const Positions& coarse_rest, std::vector<Face> coarse_faces, std::vector<Anchor> anchors,
                 const Positions& fine_rest, ProlongationOperator kind = ProlongationOperator::shell);

    int coarse_count() const { return coarse_count_; }
    int fine_count() const { return static_cast<int>(anchors_.size()); }
    const std::vector<Anchor>& anchors() const { return anchors_; }
    const std::vector<Face>& coarse_faces() const { return coarse_faces_; }

    /// Normal part gamma and in-plane part t of each fine vertex's offset: rows 0 and 1-2, m.
    const Positions& offsets() const { return offsets_; }

    Positions apply(const Positions& coarse) const;

    /// The Jacobian J of apply at `coarse`, one block per fine vertex (zero where there is no anchor).
    std::vector<Block> jacobian(const Positions& coarse) const;

    /// J^T g: the gradient with respect to the coarse positions.
    Positions pull_back(const Positions& coarse, const Positions& fine_gradient) const;

    /// U^T g: the same with the offsets held constant (PSQ equation 10), and for values per vertex.
    Positions pull_back_lagged(const Positions& fine_gradient) const;
    VecX pull_back_values(const VecX& fine_values) const;

private:
    Mat32 deformation_gradient(int face, const Positions& coarse) const;
    std::vector<PolarFrame> frames(const Positions& coarse) const;
    template <typename FaceGradient>
    Positions gather(const FaceGradient& face_gradient) const;

    int coarse_count_ = 0;
    std::vector<Face> coarse_faces_;
    std::vector<Mat2> rest_inverse_; ///< per coarse face: maps its edges to the rest frame (PSQ footnote 2)
    std::vector<Anchor> anchors_;
    Positions offsets_;
    Positions fine_rest_;
    std::vector<int> fine_of_face_, fine_of_face_starts_; ///< fine vertices anchored in each coarse face
    std::vector<int> corners_of_vertex_, corner_starts_;  ///< (3 face + corner) around each coarse vertex
};

} // namespace plisse
