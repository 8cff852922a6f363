#pragma once

#include <vector>

#include <plisse/energy/element_energy.h>
#include <plisse/linalg/coloring.h>
#include <plisse/linalg/newton_system.h>

namespace plisse {

/// Sums an ElementEnergy and its derivatives over its elements, in parallel, with the same bits for any number of
/// threads: elements are grouped and the groups coloured once, so that those of one colour share no vertex, and colours
/// are added in turn.
class ElementAssembly {
public:
    /// Refers to the energy, which must outlive it; its elements and their vertices must not change.
    ElementAssembly(const ElementEnergy& energy, int vertex_count);

    /// J; +infinity where any element is degenerate.
    double value(const Positions& x) const;
    /// Adds dW/dx, N; 3 x vertex_count.
    void add_gradient(const Positions& x, Positions& gradient) const;
    /// Finds where the elements' blocks go in the system, which was made with pairs().
    void place_in(const NewtonSystem& system);
    /// Adds the Hessian, N/m, each element's projected when `project` is set, to the system of place_in.
    void add_hessian(const Positions& x, NewtonSystem& system, bool project = true) const;

    /// Pairs of vertices that share an element, lower first, ascending.
    std::vector<Edge> pairs() const;

private:
    template <typename Body>
    void for_each_element(const Body& body) const;

    const ElementEnergy& energy_;
    ColoredGroups groups_;
    std::vector<int> block_numbers_;
    std::vector<std::size_t> block_starts_; ///< of each element's in block_numbers_
};

} // namespace plisse
