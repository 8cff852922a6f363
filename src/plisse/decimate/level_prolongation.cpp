#include <plisse/decimate/level_prolongation.h>

#include <plisse/decimate/affine_weights.h>

namespace plisse {

namespace {

/// The product of the rules on the way.
ProlongationWeights subdivision_weights(const Hierarchy& hierarchy, int from, int to) {
    ProlongationWeights weights = hierarchy.levels[static_cast<std::size_t>(from)].subdivision;
    for (int l = from + 1; l < to; ++l)
        weights = hierarchy.levels[static_cast<std::size_t>(l)].subdivision * weights;
    return weights;
}

Prolongation prolongation_between(const Hierarchy& hierarchy, int from, int to, const std::vector<Anchor>& anchors,
                                  ProlongationOperator kind) {
    const HierarchyLevel& coarse = hierarchy.levels[static_cast<std::size_t>(from)];
    const HierarchyLevel& fine = hierarchy.levels[static_cast<std::size_t>(to)];
    if (kind == ProlongationOperator::affine)
        return {affine_weights(hierarchy, from, to), coarse.faces, anchors, fine.rest};
    if (kind == ProlongationOperator::loop)
        return {subdivision_weights(hierarchy, from, to), coarse.faces, anchors, fine.rest};
    return {coarse.rest, coarse.faces, anchors, fine.rest, kind};
}

} // namespace

Prolongation prolongation_to_finest(const Hierarchy& hierarchy, int level, ProlongationOperator kind) {
    const auto& anchors = hierarchy.levels[static_cast<std::size_t>(level)].to_finest;
    return prolongation_between(hierarchy, level, hierarchy.level_count() - 1, anchors, kind);
}

Prolongation prolongation_to_next(const Hierarchy& hierarchy, int level, ProlongationOperator kind) {
    const auto& anchors = hierarchy.levels[static_cast<std::size_t>(level)].to_next;
    return prolongation_between(hierarchy, level, level + 1, anchors, kind);
}

} // namespace plisse
