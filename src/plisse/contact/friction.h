#pragma once

#include <span>
#include <utility>
#include <vector>

#include <plisse/contact/candidates.h>
#include <plisse/contact/contact.h>

namespace plisse {

struct FrictionOptions {
    double slip = 1e-4; ///< m, > 0: relative motion over which friction builds up to its limit
    /// Coulomb's coefficient of parts a and b at [a * parts + b], symmetric, >= 0; empty where nothing rubs.
    std::vector<double> coefficients;
};

/// A contact that rubs, known by its primitives.
struct RubbingPair {
    StencilKind kind = StencilKind::point_triangle;
    std::array<int, 2> primitives{};
    Vec3 elastic_slip = Vec3::Zero(); ///< m, at most FrictionOptions::slip long: the relative motion that it resists
};

/// What contacts remember from one step to the next while a body settles: measured from the last state only, each step
/// would forget its friction, and everything would creep.
struct FrictionMemory {
    Positions reference{3, 0};      ///< where further motion counts from; empty: from where the next step begins
    std::vector<RubbingPair> pairs; ///< in the order of kind, then primitives
};

/// Coulomb friction with lagged normal forces and normals (IPC, Li et al. 2020, section 5). A contact of weights w,
/// normal n and normal force N, all held since the last lag(), whose primitives have moved relative to each other by
/// u = (1 - n n^T) (sum_i w_i (x_i - reference_i) + elastic_slip), has the potential mu N f0(|u|),
///   f0(y) = y^2/e - y^3/(3 e^2) for y < e, else y - e/3,      f1(y) = f0'(y) = 2 y/e - y^2/e^2, else 1,
/// e being options.slip: friction grows from 0 to mu N over e and opposes the motion. It is convex in x.
class Friction {
public:
    static constexpr double first_grip = 10; ///< of contacts whose normal forces are not known yet

    /// mesh must outlive the object.
    Friction(const CollisionMesh& mesh, const FrictionOptions& options);

    /// Whether any contact could rub.
    bool possible() const { return possible_; }

    /// Starts a step whose relative motion counts from memory.reference.
    void begin(FrictionMemory memory);
    const FrictionMemory& memory() const { return memory_; }

    /// Takes normal forces and normals from the pairs that are active at x. A grip above 1 multiplies the forces: where
    /// they have yet to build up, a step would slide on what there is of them. A share below 1 mixes: the rest stays as
    /// it was. A contact that memory() does not know takes over from the known one on whose place it is, as where a
    /// point slides over an edge; elsewhere its motion counts from memory().reference.
    void lag(std::span<const ActivePair> active, const Positions& x, double grip = 1, double share = 1);
    /// Makes x, where a step has ended, the reference, and memory() know the pairs that are active there with their
    /// motion up to e: a contact that has moved further gives up the rest, so that it keeps its force and sticks.
    void remember(std::span<const ActivePair> active, const Positions& x);
    /// Whether the forces of the last lag() were multiplied.
    bool grips() const { return grip_ > 1; }

    /// J, up to a constant.
    double value(const Positions& x) const;
    /// Adds its derivative, N.
    void add_gradient(const Positions& x, Positions& gradient) const;
    /// Appends the vertex pairs that the Hessian couples, besides the mesh's own edges.
    void append_coupled_pairs(std::vector<Edge>& pairs) const;
    /// Adds its second derivative, N/m; positive semi-definite.
    void add_hessian(const Positions& x, NewtonSystem& system) const;

private:
    struct Contact {
        std::array<int, 4> vertices;
        Vec4 weights;
        Vec3 normal;
        Vec3 origin;      ///< m: of the relative motion, sum_i w_i reference_i - elastic_slip
        double limit = 0; ///< mu N times its share, N
        double share = 1; ///< of the mixture
    };
    double coefficient(const ActivePair& pair) const;
    bool rubs(const ActivePair& pair) const;
    Contact contact(const ActivePair& pair) const;
    Vec3 elastic_slip(const ActivePair& pair) const;
    Vec3 sliding(const Contact& contact, const Positions& x) const;

    const CollisionMesh& mesh_;
    FrictionOptions options_;
    bool possible_;
    FrictionMemory memory_;
    std::vector<std::pair<int, int>> pairs_at_; ///< vertex and number of a known pair, sorted
    std::vector<Contact> contacts_;
    double grip_ = 1;
};

} // namespace plisse
