#pragma once

#include <span>

#include <plisse/base/types.h>

namespace plisse {

/// An energy that is a sum over elements of three to six vertices each. Implementations hold structure-of-arrays data
/// and no state between calls; assembly over elements is written once, in assembly.h.
class ElementEnergy {
public:
    static constexpr int most_vertices = 6;
    virtual ~ElementEnergy() = default;

    virtual int element_count() const = 0;
    /// Vertices of an element, distinct.
    virtual std::span<const int> vertices(int element) const = 0;
    /// Energy, J; +infinity where the element is degenerate.
    virtual double value(int element, const Positions& x) const = 0;
    /// Gradient over the element's unknowns (3 per vertex, N), written to gradient[0 .. 3k).
    virtual void gradient(int element, const Positions& x, double* gradient) const = 0;
    /// Hessian (3k x 3k, column-major), projected to positive semi-definite when `project` is set.
    virtual void hessian(int element, const Positions& x, bool project, double* hessian) const = 0;
};

} // namespace plisse
