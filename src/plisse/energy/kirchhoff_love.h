#pragma once

#include <span>
#include <utility>
#include <vector>

#include <plisse/energy/assembly.h>
#include <plisse/energy/colored_elements.h>
#include <plisse/energy/shell_point.h>
#include <plisse/subdivide/surface_basis.h>

namespace plisse {

/// The elastic energy of a thin shell on a smooth surface (RMTR section 3): Kirchhoff-Love kinematics, strains
/// E0 + xi kappa over the thickness, an orthotropic material; integrated at the basis's sample points over the rest
/// surface. The unknowns are the basis's control points.
///
/// At each sample point the derivatives by a face's own (u, v) are turned into those along warp and weft, arc lengths
/// of the rest surface. So the parametrisation drops out, and E_ij = (a^alpha_rest . o_i)(a^beta_rest . o_j)
/// E_alphabeta comes of itself, o_1 and o_2 being warp and weft.
class KirchhoffLoveShell : public AssembledEnergy {
public:
    static constexpr int most_points = 16; ///< of a face

    /// basis: must outlive this. rest: its control points at rest, m; a regular surface. warp: a direction for all
    /// faces or one a face, projected onto the surface; where it stands upright on it, the next axis is taken (y, for a
    /// warp along x).
    KirchhoffLoveShell(const SurfaceBasis& basis, const Positions& rest, ShellSection section,
                       std::span<const Vec3> warp);
    KirchhoffLoveShell(const SurfaceBasis& basis, const Positions& rest, ShellSection section)
        : KirchhoffLoveShell(basis, rest, std::move(section), std::vector<Vec3>{Vec3::UnitX()}) {}

    /// +infinity where the surface has no normal at a sample point.
    double value(const Positions& x) const override;
    void add_gradient(const Positions& x, Positions& gradient) const override;
    void place_in(const NewtonSystem& system) override { elements_.place_in(system); }
    /// project: each sample point's Hessian is made positive semi-definite, see ShellPoint and ShellSection.
    void add_hessian(const Positions& x, NewtonSystem& system, bool project) const override;
    std::vector<Edge> pairs() const override { return elements_.pairs(); }

    /// Of the rest surface, m^2.
    double rest_area() const;
    /// Strain (E11, E22, E12) of the middle surface at a sample point, and the change of its curvature.
    struct Deformation {
        Vec3 strain, curvature;
    };
    Deformation deformation(int face, int point, const Positions& x) const;

private:
    /// What a sample point keeps of the rest surface.
    struct RestPoint {
        Mat2 frame;     ///< (alpha, i): a^alpha_rest . o_i
        Vec3 curvature; ///< b in the basis o
        double area;    ///< its share, m^2
    };
    /// Weights of a face's k control points in the jets of its points, five columns a point.
    template <int K>
    using JetWeights =
        Eigen::Matrix<double, K, Eigen::Dynamic, Eigen::ColMajor, K, K == Eigen::Dynamic ? K : 5 * most_points>;

    const RestPoint& rest_point(int face, int point) const {
        return points_[static_cast<std::size_t>(face * basis_.point_count() + point)];
    }
    template <int K>
    void jet_weights(int face, JetWeights<K>& weights) const;
    template <int K>
    double face_value(int face, const Positions& x) const;
    template <int K>
    void add_face_gradient(int face, const Positions& x, Positions& gradient) const;
    template <int K>
    void add_face_hessian(int face, const Positions& x, NewtonSystem& system, bool project) const;

    const SurfaceBasis& basis_;
    ShellSection section_;
    std::vector<RestPoint> points_;
    ColoredElements elements_;
};

} // namespace plisse
