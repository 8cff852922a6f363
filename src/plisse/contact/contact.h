#pragma once

#include <memory>
#include <optional>

#include <plisse/base/context.h>
#include <plisse/contact/collision_mesh.h>
#include <plisse/contact/contact_options.h>
#include <plisse/contact/pair_energy.h>
#include <plisse/geometry/ccd.h>
#include <plisse/linalg/newton_system.h>

namespace plisse {

/// A pair of primitives nearer than its activation distance. Where a point meets several faces, the pairs are the
/// places of find_nearby_places(): the separation may then be that of an edge or a vertex of the face.
struct ActivePair {
    StencilKind kind;
    std::array<int, 2> primitives; ///< vertex and face, or edge and edge
    std::array<int, 4> vertices;
    PairParameters parameters;
    Separation separation;
};

/// A pair of primitives that no longer step may bring nearer to each other.
struct LimitingPair {
    StencilKind kind;
    std::array<int, 2> primitives; ///< vertex and face, or edge and edge
    double step;                   ///< what max_step returns
    double gap;                    ///< m, where the step begins
    Vec3 place;                    ///< m: midway between the two, where the step begins
};

/// Barrier contact of one collision mesh (C-IPC, Li et al. 2021): energy, derivatives, and the largest step that keeps
/// all surfaces apart. Candidate pairs are kept over calls and found anew when the points have moved too far.
/// All positions are 3 x (number of mesh vertices).
class Contact {
public:
    Contact(CollisionMesh mesh, const ContactOptions& options);
    ~Contact();

    const CollisionMesh& mesh() const;
    const ContactOptions& options() const;

    /// Drops kept candidates: what follows then depends on the calls to come alone, to the bit.
    void forget();

    /// Barrier energy, J.
    double value(const Positions& x);
    /// Adds dB/dx, N.
    void add_gradient(const Positions& x, Positions& gradient);
    /// Vertex pairs that the Hessian at x couples, besides the mesh's own edges; pass them to NewtonSystem::begin. A
    /// pair may come up more than once.
    const std::vector<Edge>& coupled_pairs(const Positions& x);
    /// Adds the Hessian at x, made positive semi-definite pair by pair when `project` is set.
    void add_hessian(const Positions& x, NewtonSystem& system, bool project = true);

    /// Largest alpha in [0, 1] such that moving from x to x + alpha * d keeps every pair apart by at least its least
    /// distance and the lesser of options.ccd_ratio of what it has beyond that at x and of the contact distance, at
    /// every moment of the motion. Never an overestimate.
    double max_step(const Positions& x, const Positions& d);

    /// The pair that keeps max_step(x, d) below 1, the first if there are several.
    std::optional<LimitingPair> limiting_pair(const Positions& x, const Positions& d);

    /// Smallest gap, m, that is distance less thickness, over pairs of different parts and those of one part that are
    /// not near at rest, looked for within the contact distance only; infinity when there is none.
    double min_gap(const Positions& x);
    /// Smallest distance of any pair as a share of its thickness, looked for within the contact distance of that only;
    /// infinity when there is none.
    double least_thickness_share(const Positions& x);
    /// Sets options.enforced, and the barrier's stiffness to a multiple of options.stiffness.
    void enforce(double share_of_thickness, double stiffness_factor = 1);

    /// The pairs that repel at x.
    const std::vector<ActivePair>& active_pairs(const Positions& x);
    int active_pair_count(const Positions& x);

    /// Broad phase, CCD and evaluation seconds are added here; may be null.
    void set_times(PhaseTimes* times);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace plisse
