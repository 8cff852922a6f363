#include <plisse/drive/refinement_targets.h>

#include <plisse/decimate/level_prolongation.h>

namespace plisse {

Positions refinement_targets(const Discretization& discretization, int from, const Positions& x, double t) {
    const ProlongationOperator kind = discretization.model().hierarchy.prolongation;
    Positions targets = prolongation_to_next(discretization.hierarchy(), from, kind).apply(x);
    const Positions script = discretization.script(from + 1, t);
    const auto& prescribed = discretization.layout(from + 1).prescribed;
    for (int v = 0; v < targets.cols(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            if (prescribed[static_cast<std::size_t>(3 * v + axis)])
                targets(axis, v) = script(axis, v);
    return targets;
}

} // namespace plisse
