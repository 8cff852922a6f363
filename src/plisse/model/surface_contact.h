#pragma once

#include <memory>

#include <plisse/base/context.h>
#include <plisse/contact/contact.h>
#include <plisse/contact/friction.h>
#include <plisse/linalg/triple_product.h>
#include <plisse/model/subdivision_model.h>

namespace plisse {

/// Barrier contact and friction of a cloth's finest limit surface, cut into triangles, with itself and with obstacles.
/// All levels share it. Positions are those of the limit points, then of the obstacles' vertices.
class SurfaceContact {
public:
    /// Obstacles are where the scripts have them at t = 0. The model must outlive the contact.
    SurfaceContact(const SubdivisionModel& model, Context& context);

    /// Limit points with the obstacles beside them.
    Positions with_obstacles(const Positions& limit_points) const;
    int limit_count() const { return limit_count_; }
    Contact& contact() { return contact_; }

    /// Puts obstacles where the scripts have them at t, whatever is in the way.
    void place_obstacles(double t) { obstacles_ = model_.obstacles_at(t); }
    const Positions& obstacles() const { return obstacles_; }
    /// Moves them to where they are at t, but no further than what the limit points leave them. The share of the way
    /// that they went, in [0, 1].
    double move_obstacles(const Positions& limit_points, double t);
    /// The obstacle that does not get through to where it is at t, and where it is held up, in words.
    std::string held_up(const Positions& limit_points, double t);

    /// Starts a step, which depends on nothing that came before but what it is given. Friction counts motion from
    /// memory.reference, or from where all is now.
    void begin_step(const Positions& limit_points, FrictionMemory memory, double grip);
    /// Brings this share of its normal forces up to date. False where nothing can rub.
    bool update_friction(const Positions& limit_points, double share);
    const Friction& friction() const { return friction_; }

    /// Of both, J.
    double value(const Positions& surface);
    void add_gradient(const Positions& surface, Positions& gradient);
    /// Whether there is any force.
    bool acts(const Positions& surface);
    /// The Hessian there, of all vertices as if they were free.
    const NewtonSystem& hessian(const Positions& surface, bool project);

private:
    Positions obstacle_motion(double t) const;
    void lag_friction(const Positions& limit_points, double grip, double share);

    const SubdivisionModel& model_;
    int limit_count_;
    Positions obstacles_; ///< m
    Contact contact_;
    Friction friction_;
    std::vector<Edge> rubbing_pairs_; ///< of vertices, that friction couples
    NewtonSystem hessian_;
};

/// The same as an energy of one level's variables q. The surface is at base + L (q - q0), with L the limit stencils
/// times S ... S: where the level corrects a finer one, whose state it cannot hold, base is the finer one's surface at
/// q = q0 (the defect form of RMTR.md section 6), so no correction begins with surfaces in each other.
class LevelContact {
public:
    /// to_surface: L. The contact must outlive this.
    LevelContact(SurfaceContact& contact, VertexWeights to_surface);
    LevelContact(const LevelContact&) = delete;
    LevelContact& operator=(const LevelContact&) = delete;

    /// From now on the surface is L q, and the obstacles are where they are now.
    void stand_alone();
    /// From now on it is at `base` where the variables are q0.
    void correct(Positions q0, Positions base);
    /// Of the finest limit points.
    Positions limit_points(const Positions& q) const;

    double value(const Positions& q);
    void add_gradient(const Positions& q, Positions& gradient);
    double max_step(const Positions& q, const Positions& d);
    /// Finds the Hessian at q, and the pairs of variables that it couples.
    const std::vector<Edge>& find_hessian(const Positions& q, bool project);
    /// Adds what find_hessian found.
    void add_hessian(NewtonSystem& system) const;
    double min_gap(const Positions& q);
    /// The part of friction in value(), J.
    double friction(const Positions& q);

private:
    const Positions& surface(const Positions& q);
    template <typename Visit>
    void for_each_block(const Visit& visit) const;

    SurfaceContact& shared_;
    VertexWeights to_surface_; ///< with an empty row for every vertex of an obstacle
    TripleProduct product_;
    const NewtonSystem* found_ = nullptr; ///< null where nothing repels
    std::vector<Edge> coupled_;
    Positions q0_, base_; ///< empty where the level stands alone
    Positions q_memo_, surface_memo_;
};

} // namespace plisse
