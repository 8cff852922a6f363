#pragma once

#include <vector>

#include <plisse/energy/element_energy.h>
#include <plisse/linalg/coloring.h>
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
/// threads: elements are grouped and the groups coloured once, so that those of one colour share no vertex, and colours
/// are added in turn.
class ElementAssembly : public AssembledEnergy {
public:
    /// Refers to the energy, which must outlive it; its elements and their vertices must not change.
    ElementAssembly(const ElementEnergy& energy, int vertex_count);

    double value(const Positions& x) const override;
    void add_gradient(const Positions& x, Positions& gradient) const override;
    void place_in(const NewtonSystem& system) override;
    /// Each element's is projected when `project` is set.
    void add_hessian(const Positions& x, NewtonSystem& system, bool project) const override;
    std::vector<Edge> pairs() const override;

private:
    template <typename Body>
    void for_each_element(const Body& body) const;

    const ElementEnergy& energy_;
    ColoredGroups groups_;
    std::vector<int> block_numbers_;
    std::vector<std::size_t> block_starts_; ///< of each element's in block_numbers_
};

} // namespace plisse
