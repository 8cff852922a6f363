#pragma once

#include <string>
#include <vector>

#include <plisse/linalg/newton_system.h>

namespace plisse {

/// What keeps a step short, in words.
struct StepLimit {
    std::string cause;  ///< such as "contact"; empty where nothing does
    std::string detail; ///< what exactly, and where
};

/// What a solver minimises: a function of 3n unknowns, some of which are prescribed and on their way to given targets.
/// The solver knows of nothing else. Calls at the same x may share work, so x is passed by value identity.
class Objective {
public:
    virtual ~Objective() = default;

    /// Value at x; +infinity where x is not feasible.
    virtual double value(const VecX& x) = 0;
    /// How far off round-off may put a value, whatever the value is.
    virtual double round_off() const { return 0; }
    virtual void gradient(const VecX& x, VecX& gradient) = 0;
    /// Fills the system (between begin and the last add) with the Hessian at x, or, when `project` is set, with a
    /// positive semi-definite approximation of it.
    virtual void assemble(const VecX& x, NewtonSystem& system, bool project) = 0;
    /// The matrix the solver works on; it says which unknowns are prescribed.
    virtual NewtonSystem& system() = 0;
    /// Targets of the prescribed unknowns; other entries mean nothing.
    virtual const VecX& targets() const = 0;
    /// Number of the script that each prescribed unknown follows; empty where all follow one.
    virtual const std::vector<int>& script_of() const {
        static const std::vector<int> one;
        return one;
    }
    /// Largest alpha in [0, 1] for which the whole way from x to x + alpha d is feasible.
    virtual double max_step(const VecX& x, const VecX& d) = 0;
    /// What keeps max_step(x, d) below 1. May take as long as that.
    virtual StepLimit step_limit(const VecX&, const VecX&) { return {}; }
    /// Called with every accepted x.
    virtual void on_accepted(const VecX&) {}
};

} // namespace plisse
