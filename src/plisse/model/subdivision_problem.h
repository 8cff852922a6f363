#pragma once

#include <memory>
#include <vector>

#include <plisse/base/context.h>
#include <plisse/energy/kirchhoff_love.h>
#include <plisse/energy/surface_integrals.h>
#include <plisse/model/subdivision_model.h>
#include <plisse/model/surface_contact.h>
#include <plisse/solve/objective.h>

namespace plisse {

/// Places on the boundary that handles hold, on one level. A held side has four, weighted by the length of boundary
/// that each stands for; a point held alone stands for the length of a mean side.
struct HeldPlaces {
    SurfaceSamples samples;
    std::vector<int> handle; ///< of each: the number of the handle that holds it
    Positions rest;          ///< m
};
/// On every level, the coarsest first: the finest level's places, carried down by S, so that what they cost is the same
/// on all (RMTR.md's S' B_fine S = B_coarse).
std::vector<HeldPlaces> held_places(const SubdivisionModel& model);

/// Stiffness of what holds a boundary, N/m^3: the scene's, or h^-5 (RMTR section 7.1).
double boundary_penalty(const SubdivisionModel& model);

/// One implicit Euler step, or where time_step is 0 the equilibrium at a time.
struct SurfaceStep {
    double t = 0;           ///< s
    double time_step = 0;   ///< s
    Positions inertial;     ///< q_n + dt v_n, of the finest level; empty without inertia
    FrictionMemory rubbing; ///< without a reference, the motion of contacts counts from where the step begins
    bool grips = false;     ///< a first step, for which normal forces of friction have yet to build up
};

/// What a step minimises on one level (RMTR section 3): elastic energy, gravity, inertia and what holds the boundary,
///   f = int sum_k w_k psi dA - int rho g . x dA + 1/(2 dt^2) |q - q^|_M^2 + beta/2 sum_p l_p |x_p - b_p|^2 + B,
/// with l_p the length of boundary that place p stands for, b_p where its handle wants it, and B barrier and
/// friction of the finest level's surface. The unknowns are the level's variables, all of them free.
class SubdivisionProblem final : public Objective {
public:
    /// contact: null where nothing may touch; to_surface: of the finest limit points, from this level's variables. The
    /// model and the contact must outlive the problem.
    SubdivisionProblem(const SubdivisionModel& model, int level, HeldPlaces held, double penalty, Context& context,
                       SurfaceContact* contact = nullptr, const VertexWeights& to_surface = {});

    /// inertial: as in the step, of this level.
    void begin_step(const SurfaceStep& step, Positions inertial);

    double value(const VecX& x) override;
    double round_off() const override { return 0; }
    void gradient(const VecX& x, VecX& gradient) override;
    void assemble(const VecX& x, NewtonSystem& system, bool project) override;
    NewtonSystem& system() override { return system_; }
    const VecX& targets() const override { return no_targets_; }
    double max_step(const VecX& x, const VecX& d) override;
    StepLimit step_limit(const VecX& x, const VecX& d) override;

    /// Where there is contact: see LevelContact.
    LevelContact* contact() { return contact_.get(); }

    struct Energies {
        double elastic = 0, gravity = 0, inertia = 0, held = 0, contact = 0, friction = 0; ///< J
    };
    Energies energies(const VecX& x);
    /// Force on each held place, N, and where it is.
    struct Holding {
        Positions places, forces;
    };
    Holding holding(const VecX& x) const;
    /// Of each held place from where its handle wants it, m.
    std::vector<double> away_from_targets(const VecX& x) const;
    const std::vector<int>& handle_of_place() const { return held_.handle; }
    /// The largest force on a vertex of the total over the largest of any one term.
    double residual(const VecX& x);
    /// Principal stretch of the middle surface, over the sample points.
    double largest_stretch(const VecX& x) const;

private:
    template <typename Visit>
    void for_each_part(const Visit& visit) const;

    const SubdivisionModel& model_;
    HeldPlaces held_;
    double penalty_;
    Context& context_;
    SurfaceBasis basis_;
    KirchhoffLoveShell shell_;
    Eigen::SparseMatrix<double> mass_; ///< kg
    SurfaceInertia inertia_;
    PointPenalty boundary_;
    DeadLoads gravity_;
    std::unique_ptr<LevelContact> contact_; ///< null where nothing may touch
    bool has_inertia_ = false;
    NewtonSystem system_;
    VecX no_targets_;
};

} // namespace plisse
