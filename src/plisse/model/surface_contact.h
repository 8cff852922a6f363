#pragma once

#include <memory>

#include <plisse/base/context.h>
#include <plisse/contact/contact.h>
#include <plisse/linalg/triple_product.h>
#include <plisse/model/subdivision_model.h>

namespace plisse {

/// Barrier contact of a cloth's finest limit surface, cut into triangles, with itself and with obstacles. All levels
/// share it. Positions are those of the limit points, then of the obstacles' vertices.
class SurfaceContact {
public:
    SurfaceContact(const SubdivisionModel& model, Context& context);

    /// Limit points with the obstacles beside them.
    Positions with_obstacles(const Positions& limit_points) const;
    int limit_count() const { return limit_count_; }
    Contact& contact() { return contact_; }
    /// The Hessian there, of all vertices as if they were free.
    const NewtonSystem& hessian(const Positions& surface, bool project);

private:
    int limit_count_;
    Positions obstacles_; ///< m
    Contact contact_;
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

    /// From now on the surface is L q.
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
