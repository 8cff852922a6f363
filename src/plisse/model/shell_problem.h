#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include <plisse/contact/contact.h>
#include <plisse/contact/friction.h>
#include <plisse/model/dead_loads.h>
#include <plisse/model/pulls.h>
#include <plisse/model/shell_energies.h>
#include <plisse/model/strain_limit.h>
#include <plisse/solve/objective.h>
#include <plisse/transfer/galerkin.h>
#include <plisse/transfer/prolongation.h>

namespace plisse {

/// Which energies a level below the finest minimises.
enum class EnergiesOf {
    finest, ///< the proxy of PSQ equation 2: elasticity and loads on the finest mesh through P^l
    level   ///< the level's own mesh, as `direct --level` does
};

/// Forces per vertex of the level by term (N, the negative gradients).
struct NodalForces {
    Positions elastic, strain_limit, contact, friction, gravity, loads;
    Positions total() const { return elastic + strain_limit + contact + friction + gravity + loads; }
};

/// The pair that repels with the smallest gap for where it begins to.
struct TightestPair {
    double gap = 0;    ///< m
    double share = 1;  ///< the gap over that at which it begins to repel; 1 where no pair repels
    std::string words; ///< what it is, and where; empty where there is none
};

struct EnergyBreakdown {
    double elastic = 0, strain_limit = 0, contact = 0, friction = 0, gravity = 0, loads = 0;
};

/// F_l of PSQ equations 2 and 3 as an Objective: barrier contact, friction, strain limit and inertia on level l's mesh,
/// elasticity and loads on the finest mesh through the direct prolongation P^l (or on level l itself), over one time
/// step.
class ShellProblem : public Objective {
public:
    /// The discretization must outlive the problem.
    ShellProblem(const Discretization& discretization, int level, EnergiesOf energies_of, Context& context);
    ~ShellProblem() override;

    int level() const { return level_; }
    int vertex_count() const { return static_cast<int>(mass_.size()); }

    /// Starts the step to time t: inertia 1/(2 h^2) |x - anchor|_M^2, loads and scripts at t, directions of follower
    /// pressure frozen at `current`. Contacts slide relative to `current`; in a first step, for which normal forces
    /// have yet to build up, they grip until update_friction().
    void begin_step(const Positions& current, const Positions& anchor, double t, double h, bool is_first = false);
    /// Starts a step of settling: the same with inertia about `current`, and contacts that carry on what they remember,
    /// or grip where nothing has come before.
    void begin_settling_step(const Positions& current, double t, double h, const FrictionMemory& memory);
    /// Starts a step from a state beyond strain limits, for a problem of the level's own energies: no loads, no
    /// friction, and limits raised as StrainLimit::raise does. held: the unknowns that stay where they are.
    void begin_relaxation(const Positions& current, const std::vector<std::uint8_t>& held, double least_room,
                          double stiffening);
    /// What contacts remember of the step begun last.
    const FrictionMemory& friction_memory() const { return friction_->memory(); }
    /// Lets contacts take in that the step has ended at x.
    void remember_friction(const VecX& x);
    /// Whether anything could rub.
    bool friction_possible() const { return friction_->possible(); }
    /// Whether forces are still those of a first step's grip.
    bool friction_grips() const { return friction_possible() && friction_->grips(); }
    /// Brings this share of the normal forces that friction goes by up to x. False where nothing can rub.
    bool update_friction(const VecX& x, double share = 1);

    double value(const VecX& x) override;
    double round_off() const override { return value_round_off_; }
    void gradient(const VecX& x, VecX& gradient) override;
    void assemble(const VecX& x, NewtonSystem& system, bool project) override;
    NewtonSystem& system() override { return system_; }
    const VecX& targets() const override { return targets_; }
    const std::vector<int>& script_of() const override { return discretization_.layout(level_).script_of; }
    double max_step(const VecX& x, const VecX& d) override;
    StepLimit step_limit(const VecX& x, const VecX& d) override;

    /// Forces without inertia.
    NodalForces forces(const VecX& x);
    EnergyBreakdown energies(const VecX& x);
    /// Largest nodal force of the total on free unknowns, over the largest nodal force of any one term; 0 where all
    /// forces are round-off.
    double residual(const VecX& x);
    double min_gap(const VecX& x);
    /// Of each vertex of the level, over the pairs that repel; NaN where there is none.
    VecX vertex_gaps(const VecX& x);
    /// Of the pairs with an unknown that is free.
    TightestPair tightest_pair(const VecX& x);
    /// As Contact's.
    double least_thickness_share(const VecX& x);
    /// As Contact's enforce().
    void enforce_thickness(double share, double stiffness_factor = 1);
    /// Largest principal stretch of the bodies on the level's own mesh, which is what frames hold.
    double max_stretch(const VecX& x);
    int active_contacts(const VecX& x);
    /// Positions of the mesh that carries the elasticity.
    const Positions& carried(const VecX& x);

private:
    struct Carrier; ///< prolongation and Galerkin products of a proxy
    const Positions& level_positions(const VecX& x);
    Positions pull_back(const VecX& x, const Positions& carried_gradient);
    bool uses_galerkin() const;
    void estimate_round_off();
    void build_system(const std::vector<std::uint8_t>& prescribed);
    void set_step(const Positions& current, const Positions& anchor, double t, double h);
    void begin_friction(const Positions& current, const FrictionMemory& memory, bool is_first);
    std::vector<Edge> coupled_pairs(const Positions& points);
    std::string named_corners(int level, std::span<const int> corners) const;
    std::string in_words(const LimitingPair& pair) const;

    const Discretization& discretization_;
    Context& context_;
    int level_;
    DeadLoads dead_loads_;
    VecX mass_;                                    ///< kg per level vertex
    std::unique_ptr<Carrier> carrier_;             ///< null where the level carries its own elasticity
    std::unique_ptr<ShellEnergies> elasticity_;    ///< on the carrying mesh
    std::unique_ptr<ShellEnergies> level_bending_; ///< when bending_on is level
    std::unique_ptr<ShellEnergies> curvature_;     ///< the level's own Hessian, when curvature is own
    Pulls pulls_;                                  ///< on the carrying mesh
    Pulls level_pulls_;                            ///< on the level, when curvature is own
    RestTriangles triangles_;                      ///< of the bodies, on the level
    StrainLimit strain_limit_;
    std::unique_ptr<Contact> contact_;
    std::unique_ptr<Friction> friction_;
    NewtonSystem system_;

    VecX targets_;
    Positions anchor_;
    double inverse_h_squared_ = 0;
    Positions gravity_forces_, load_forces_; ///< N on the carrying mesh, at the step's time
    double force_round_off_ = 0, value_round_off_ = 0;

    Positions x_memo_, y_memo_;
};

} // namespace plisse
