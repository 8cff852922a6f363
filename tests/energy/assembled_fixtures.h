#pragma once

#include <linalg/dense_system.h>
#include <plisse/energy/assembly.h>

namespace plisse::testing {

/// A system of an energy's Hessian, nothing prescribed.
inline NewtonSystem assembled_hessian(AssembledEnergy& energy, const Positions& x, bool project) {
    NewtonSystem system(std::vector<std::uint8_t>(static_cast<std::size_t>(x.size()), 0), energy.pairs());
    system.set_prescribed_step(VecX::Zero(x.size()));
    energy.place_in(system);
    system.begin({});
    energy.add_hessian(x, system, project);
    return system;
}
inline Eigen::MatrixXd dense_hessian(AssembledEnergy& energy, const Positions& x, bool project) {
    return dense(assembled_hessian(energy, x, project));
}

inline VecX gradient_of(const AssembledEnergy& energy, const VecX& x) {
    Positions gradient = Positions::Zero(3, x.size() / 3);
    energy.add_gradient(as_positions(x), gradient);
    return as_vector(gradient);
}

/// Errors of an energy's derivatives against central differences, relative to the derivatives' norms, and of the
/// Hessian's symmetry.
struct AssembledErrors {
    double gradient, hessian;
};
inline AssembledErrors assembled_errors(AssembledEnergy& energy, const Positions& at, double step) {
    const VecX x = as_vector(at);
    const VecX gradient = gradient_of(energy, x);
    const Eigen::MatrixXd hessian = dense_hessian(energy, at, false);
    AssembledErrors errors{0, 0};
    for (int k = 0; k < x.size(); ++k) {
        VecX above = x, below = x;
        above[k] += step;
        below[k] -= step;
        const double width = above[k] - below[k];
        const double slope = (energy.value(as_positions(above)) - energy.value(as_positions(below))) / width;
        const VecX column = (gradient_of(energy, above) - gradient_of(energy, below)) / width;
        errors.gradient += std::pow(slope - gradient[k], 2);
        errors.hessian += (column - hessian.col(k)).squaredNorm();
    }
    return {std::sqrt(errors.gradient) / gradient.norm(), std::sqrt(errors.hessian) / hessian.norm()};
}

} // namespace plisse::testing
