#pragma once

#include <plisse/energy/assembly.h>
#include <plisse/energy/strain_limit.h>
#include <plisse/model/discretization.h>

namespace plisse {

/// The strain limits of all bodies on the mesh of one level: a barrier on the stretches of the faces of bodies that
/// have one. It begins to act half way to the limit, and its force, whatever the limit is, is a share of what
/// stretching the membrane to twice its length takes (docs/decisions/0013).
class StrainLimit {
public:
    StrainLimit(const Discretization& discretization, int level);
    StrainLimit(const StrainLimit&) = delete; // the assembly refers to the energy
    StrainLimit& operator=(const StrainLimit&) = delete;

    /// Whether any body has a limit; everything else is 0 or 1 then.
    bool possible() const { return energy_.element_count() > 0; }

    double value(const Positions& x) const { return assembly_.value(x); }
    void add_gradient(const Positions& x, Positions& gradient) const { assembly_.add_gradient(x, gradient); }
    /// The blocks of the faces' edges must be in the system.
    void place_in(const NewtonSystem& system) { assembly_.place_in(system); }
    void add_hessian(const Positions& x, NewtonSystem& system) const { assembly_.add_hessian(x, system, true); }
    double max_step(const Positions& x, const Positions& d) const { return energy_.max_step(x, d); }

    /// The faces that are stretched too far, and the worst of them.
    struct Excess {
        int faces = 0;
        int body = -1;
        Vec3 place = Vec3::Zero(); ///< m
        double stretch = 0, limit = 0;
        double share = 0; ///< stretch beyond the limit, over the width in which the barrier acts
    };
    /// Of faces with less than this share of that width left below their material's limit.
    Excess excess(const Positions& x, double least_room) const;

    /// Raises the limits of those faces to somewhat above what they are stretched at x, and sets all others' to the
    /// material's, with a barrier stiffer than usual by a factor.
    void raise(const Positions& x, double least_room, double stiffening);

private:
    /// Faces of bodies that have a limit.
    struct LimitedFaces {
        std::vector<Face> faces;
        std::vector<int> body;
        StrainLimits limits;
    };
    static LimitedFaces limited_faces(const Discretization& discretization, int level);
    StrainLimit(const Positions& rest, LimitedFaces limited);

    StrainLimits limits_; ///< the materials'
    std::vector<int> face_body_;
    StrainLimitEnergy energy_;
    ElementAssembly assembly_;
};

} // namespace plisse
