#pragma once

#include <plisse/model/discretization.h>

namespace plisse {

/// The dead loads of a model on its finest mesh: masses, weight, point and area loads.
class DeadLoads {
public:
    explicit DeadLoads(const Discretization& discretization);

    const VecX& masses() const { return masses_; } ///< kg per finest vertex; 0 on obstacles
    Positions weight(double t) const;              ///< N per finest vertex
    Positions loads(double t) const;               ///< N per finest vertex

private:
    const Model& model_;
    VecX masses_;
    VecX areas_; ///< m^2 at rest
};

} // namespace plisse
