#pragma once

#include <cstdint>
#include <vector>

#include <plisse/energy/element_energy.h>
#include <plisse/mesh/connectivity.h>

namespace plisse {

/// Interior edges of a mesh as hinges, by edge number: one for each pair of faces of an edge. Which way the second face
/// turns makes no difference.
struct Hinges {
    /// The edge as its first face runs along it, then the corner of that face and of the other (geometry/dihedral.h).
    std::vector<std::array<int, 4>> vertices;
    std::vector<std::array<int, 2>> faces;
    std::vector<int> edges;
    int size() const { return static_cast<int>(vertices.size()); }
};
Hinges interior_hinges(const Connectivity& connectivity, std::span<const Face> faces);

/// What part of its stiffness as an edge of two faces each hinge has: 1 unless the edge is a joint of more,
///     (1/A_p + 1/A_q) / sum_r 1/A_r,     r over all faces of the edge, A at rest.
/// That is a rigid joint: every face p bends by a spring K_p ~ 1/A_p from the edge to its middle (two in series make
/// the hinge of a plain edge), all springs begin at the joint, and the joint turns freely. With its turn minimised out,
/// what is left between p and q has the stiffness K_p K_q/sum_r K_r. So a face that carries no moment, such as an
/// unloaded rib, leaves the other two the stiffness that they have without it (docs/decisions/0022).
std::vector<double> hinge_shares(const Hinges& hinges, const Connectivity& connectivity, std::span<const Face> faces,
                                 const Positions& rest);

/// D = E h^3/(12 (1 - nu^2)), N m.
double bending_rigidity(double youngs_modulus, double poisson_ratio, double thickness);

/// Bending material of each hinge.
struct HingeMaterials {
    std::vector<double> scaled_rigidity; ///< c D, N m; c = 1 is plate theory for sheets rolled along mesh lines
    std::vector<std::uint8_t> flat;      ///< 1: rest angle 0 whatever the rest positions say
};

/// What stands for the Hessian k g g^T + k (theta - theta_rest) d2 theta, with k = 2 W/(theta - theta_rest)^2 and
/// g = d theta, where a positive semi-definite one is asked for.
enum class HingeHessian {
    gauss_newton, ///< k g g^T: exact at the rest angle
    projected     ///< the positive part of the whole
};

/// Discrete-shell bending over interior edges,
///   W = c D/2 |e|^2/(A1 + A2) (theta - theta_rest)^2,     |e|, A1, A2 at rest          (DESIGN.md section 4)
/// Public C-IPC codes use c = 3 (C-IPC 2021). The projection is exact in the coordinates of DihedralModes, in closed
/// form.
///
/// theta lies in [-pi, pi] and theta - theta_rest is taken as it is. Faces that cannot pass through each other keep
/// theta inside, where W is smooth; wrapping the difference instead would make a sharp rest crease that is turned
/// inside out jump ahead. Only where nothing keeps the faces apart can theta pass +-pi, and W jump.
class HingeEnergy : public ElementEnergy {
public:
    /// rest: rest positions, m; hinges: four vertices each, of two faces of positive area; one material a hinge.
    HingeEnergy(const Positions& rest, std::vector<std::array<int, 4>> hinges, const HingeMaterials& materials,
                HingeHessian kind = HingeHessian::gauss_newton);

    int element_count() const override { return static_cast<int>(hinges_.size()); }
    std::span<const int> vertices(int hinge) const override { return hinges_[static_cast<std::size_t>(hinge)]; }
    double value(int hinge, const Positions& x) const override;
    void gradient(int hinge, const Positions& x, double* gradient) const override;
    void hessian(int hinge, const Positions& x, bool project, double* hessian) const override;

    double rest_angle(int hinge) const { return rest_angles_[static_cast<std::size_t>(hinge)]; }
    double angle(int hinge, const Positions& x) const;

private:
    std::vector<std::array<int, 4>> hinges_;
    std::vector<double> stiffness_; ///< c D |e|^2/(A1 + A2), N m
    std::vector<double> rest_angles_;
    HingeHessian kind_;
};

} // namespace plisse
