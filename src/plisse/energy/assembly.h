#pragma once

#include <vector>

#include <plisse/energy/colored_elements.h>
#include <plisse/energy/element_energy.h>
#include <plisse/linalg/newton_system.h>

namespace plisse {

/// An energy of all positions of a mesh with its derivatives.
class AssembledEnergy {
public:
    virtual ~AssembledEnergy() = default;

    /// J; +infinity where any element is degenerate.
    virtual double value(const Positions& x) const = 0;
    /// Adds dW/dx, N; 3 x vertex_count.
    virtual void add_gradient(const Positions& x, Positions& gradient) const = 0;
    /// Finds where the Hessian's blocks go in the system, which was made with pairs().
    virtual void place_in(const NewtonSystem& system) = 0;
    /// Adds the Hessian, N/m, or, when `project` is set, a positive semi-definite stand-in for it, to the system of
    /// place_in.
    virtual void add_hessian(const Positions& x, NewtonSystem& system, bool project) const = 0;
    /// Pairs of vertices that the Hessian couples, lower first, ascending.
    virtual std::vector<Edge> pairs() const = 0;
};

/// Sums an ElementEnergy and its derivatives over its elements, in parallel, with the same bits for any number of
/// threads.
class ElementAssembly : public AssembledEnergy {
public:
    /// Refers to the energy, which must outlive it; its elements and their vertices must not change.
    ElementAssembly(const ElementEnergy& energy, int vertex_count);

    double value(const Positions& x) const override;
    void add_gradient(const Positions& x, Positions& gradient) const override;
    void place_in(const NewtonSystem& system) override { elements_.place_in(system); }
    /// Each element's is projected when `project` is set.
    void add_hessian(const Positions& x, NewtonSystem& system, bool project) const override;
    std::vector<Edge> pairs() const override { return elements_.pairs(); }

private:
    const ElementEnergy& energy_;
    ColoredElements elements_;
};

} // namespace plisse
