#pragma once

#include <memory>
#include <vector>

#include <plisse/energy/assembly.h>
#include <plisse/energy/hinge.h>

namespace plisse {

/// Bending material of each face.
struct KoiterMaterials {
    std::vector<double> scaled_rigidity; ///< c D > 0, N m; c = 1 is plate theory
    std::vector<double> poisson_ratio;   ///< in (-1, 0.5)
    std::vector<std::uint8_t> flat;      ///< 1: rest curvature 0 whatever the rest positions say
};

/// Bending by the shape operator of mid-edge normals, face by face. On edge k of a face (length l_k, unit normal m_k in
/// the face, both at rest) the surface's normal is turned about the edge by alpha_k from the face's own. The change of
/// curvature and the energy, of a St Venant-Kirchhoff plate, are
///     K = sum_k l_k/A (alpha_k - alpha_k,rest) m_k m_k^T,      W = A c D/2 [(1 - nu) K:K + nu (tr K)^2],
/// which is Morley's plate element with turns in place of slopes (Grinspun et al. 2006 for the shape operator): unlike
/// hinges it converges to plate and shell theory on any mesh, twist and saddles included.
///
/// The two faces of an edge share the turn theta between their normals: alpha = s theta + phi and (1 - s) theta - phi,
/// where s is such that phi = 0 bends both by the same moment, were it not for their other edges. An edge of one face
/// has alpha = phi. At an edge of more faces, a rigid joint, the normal of the joint is turned by phi from the first
/// face, and the other faces have alpha = +-(theta - theta_rest - phi), theta between the first face and them, with the
/// sign of a face that turns the other way than the first changed. The turns phi, one an edge, are held here; they
/// follow the vertices in x, three to a column: x is (x, phi). KoiterBending finds those that minimise the energy.
/// Elements are faces with the corners beyond their edges.
class KoiterFaces : public ElementEnergy {
public:
    /// rest: rest positions, m; faces of positive area; one material a face. `flat` does not hold of joints.
    KoiterFaces(const Positions& rest, std::span<const Face> faces, const KoiterMaterials& materials);

    int element_count() const override { return static_cast<int>(faces_.size()); }
    std::span<const int> vertices(int face) const override;
    double value(int face, const Positions& x) const override;
    void gradient(int face, const Positions& x, double* gradient) const override;
    /// Projected: the square of the turns' first derivatives, plus the positive part of the rest.
    void hessian(int face, const Positions& x, bool project, double* hessian) const override;

    int vertex_count() const { return vertex_count_; }
    /// Edges of the faces' Connectivity.
    int edge_count() const { return edge_count_; }
    /// Columns that hold the turns.
    int turn_columns() const { return (edge_count_ + 2) / 3; }

    /// What KoiterBending needs of a face.
    struct FaceEdges {
        std::array<int, 3> edges;
        Vec3 sign;      ///< of phi in alpha
        Vec3 share;     ///< of theta in alpha
        Mat3 stiffness; ///< d2 W / d alpha2, N m
    };
    const FaceEdges& edges_of(int face) const { return faces_[static_cast<std::size_t>(face)].edges; }
    /// alpha - alpha_rest of the face's edges without what phi adds, rad; NaN where a face has no area.
    Vec3 angles(int face, const Positions& x) const;

private:
    struct Side {
        int hinge = -1;               ///< -1 on a boundary, and for the first face of a joint
        std::array<int, 4> corners{}; ///< of the hinge, as vertices of the element
    };
    struct ElementFace {
        FaceEdges edges;
        std::array<Side, 3> sides;
        std::array<int, most_vertices> vertices;
        int vertex_count;
    };
    std::vector<int> find_hinges(const Positions& rest, const Connectivity& connectivity, std::span<const Face> faces,
                                 std::span<const std::uint8_t> flat);
    void number_vertices(ElementFace& element, const Face& face) const;
    void share_angles(const Connectivity& connectivity);
    Vec3 turns(int face, const Positions& x) const;

    int vertex_count_, edge_count_;
    std::vector<ElementFace> faces_;
    std::vector<std::array<int, 4>> hinges_;
    std::vector<double> rest_angles_; ///< per hinge
};

/// The least of KoiterFaces over the turns of its edges, as an energy of the positions alone. It is quadratic in the
/// turns with a constant matrix, which is factorised once; gradients need no derivative of the turns. The Hessian is
/// that with the turns held: it couples vertices alone, and is too stiff by a factor of 1.02 for the smoothest waves of
/// an irregular plate at rest, 1.3 for middling and 2.7 for the roughest ones (docs/decisions/0019).
class KoiterBending : public AssembledEnergy {
public:
    KoiterBending(const Positions& rest, std::span<const Face> faces, const KoiterMaterials& materials);
    ~KoiterBending() override;

    double value(const Positions& x) const override;
    void add_gradient(const Positions& x, Positions& gradient) const override;
    void place_in(const NewtonSystem& system) override { assembly_.place_in(system); }
    void add_hessian(const Positions& x, NewtonSystem& system, bool project) const override;
    std::vector<Edge> pairs() const override { return assembly_.pairs(); }

    const KoiterFaces& faces() const { return faces_; }
    /// (x, phi) with the turns that belong to x; not finite where a face has no area.
    const Positions& with_turns(const Positions& x) const;

private:
    struct TurnSolver;

    KoiterFaces faces_;
    ElementAssembly assembly_;
    std::unique_ptr<TurnSolver> solver_;
    mutable Positions with_turns_; ///< of the last x: value, gradient and Hessian are asked for one after another
};

} // namespace plisse
