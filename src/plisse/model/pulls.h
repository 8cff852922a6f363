#pragma once

#include <plisse/linalg/newton_system.h>
#include <plisse/model/discretization.h>

namespace plisse {

/// The pulls of a model on one of its levels: springs W = 1/2 k |y - p(t)|^2, where y is the finest vertex that is
/// pulled, or on a coarser level the point of it that the vertex is anchored to.
class Pulls {
public:
    Pulls() = default; ///< none
    /// The discretization must outlive them.
    Pulls(const Discretization& discretization, int level);

    /// Takes every place at this time, s.
    void set_time(double t);

    double value(const Positions& x) const;
    void add_gradient(const Positions& x, Positions& gradient) const;
    /// Couples no vertices but the corners of one face.
    void add_hessian(NewtonSystem& system) const;

private:
    struct Spring {
        Face vertices; ///< of the level
        Vec3 weights;
        double stiffness; ///< N/m
        const Track<Vec3>* place;
        Vec3 to; ///< m, at the time set
    };
    static Vec3 stretch(const Spring& spring, const Positions& x);

    std::vector<Spring> springs_;
};

} // namespace plisse
