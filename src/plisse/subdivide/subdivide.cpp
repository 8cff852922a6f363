#include <plisse/subdivide/subdivide.h>

#include <cassert>
#include <numeric>

namespace plisse {

namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// Every vertex as a corner of the first face that uses it.
std::vector<Anchor> own_anchors(const HierarchyLevel& level) {
    std::vector<Anchor> anchors(level.part.size());
    for (std::size_t f = 0; f < level.faces.size(); ++f)
        for (int k = 0; k < 3; ++k)
            if (Anchor& anchor = anchors[at(level.faces[f][at(k)])]; anchor.face < 0)
                anchor = {static_cast<int>(f), Vec3::Unit(k)};
    return anchors;
}

/// The same places on the surface that was divided.
void carry_down(std::vector<Anchor>& anchors, const LoopStep& step) {
    for (Anchor& anchor : anchors)
        if (anchor.face >= 0)
            anchor = {step.parent[at(anchor.face)], step.corners[at(anchor.face)] * anchor.weights};
}

HierarchyLevel make_level(const LabelledSurface& surface, Positions rest) {
    HierarchyLevel level;
    level.rest = std::move(rest);
    level.faces = surface.faces;
    level.part = surface.part;
    level.label = surface.label;
    return level;
}

void number_vertices(std::vector<HierarchyLevel>& levels, const std::vector<LoopStep>& steps) {
    std::vector<int>& finest = levels.back().vertex_ids;
    finest.resize(levels.back().part.size());
    std::iota(finest.begin(), finest.end(), 0);
    for (std::size_t l = steps.size(); l-- > 0;)
        for (int number : steps[l].fine_number)
            levels[l].vertex_ids.push_back(levels[l + 1].vertex_ids[at(number)]);
}

void number_faces(std::vector<HierarchyLevel>& levels, const std::vector<LoopStep>& steps) {
    std::vector<int>& coarsest = levels.front().face_ids;
    coarsest.resize(levels.front().faces.size());
    std::iota(coarsest.begin(), coarsest.end(), 0);
    for (std::size_t l = 0; l < steps.size(); ++l)
        for (int parent : steps[l].parent)
            levels[l + 1].face_ids.push_back(levels[l].face_ids[at(parent)]);
}

} // namespace

Hierarchy subdivide(const SubdivisionInput& input, int levels) {
    assert(levels >= 1 && static_cast<std::size_t>(input.rest.cols()) == input.surface.part.size());
    Hierarchy hierarchy;
    std::vector<LoopStep> steps;
    hierarchy.levels.push_back(make_level(input.surface, input.rest));
    for (int l = 0; l + 1 < levels; ++l) {
        const LabelledSurface& coarse = l == 0 ? input.surface : steps.back().fine;
        steps.push_back(loop_step(coarse, input.kept_part, input.label_between));
        hierarchy.levels.back().subdivision = steps.back().weights;
        hierarchy.levels.push_back(
            make_level(steps.back().fine, subdivided_positions(hierarchy, l, hierarchy.levels.back().rest)));
    }
    number_vertices(hierarchy.levels, steps);
    number_faces(hierarchy.levels, steps);

    std::vector<Anchor> finest = own_anchors(hierarchy.finest());
    for (int l = levels - 1; l >= 0; --l) {
        HierarchyLevel& level = hierarchy.levels[at(l)];
        if (l + 1 < levels) {
            carry_down(finest, steps[at(l)]);
            level.to_next = own_anchors(hierarchy.levels[at(l + 1)]);
            carry_down(level.to_next, steps[at(l)]);
        }
        level.to_finest = finest;
        level.on_input = own_anchors(level);
        for (int below = l; below-- > 0;)
            carry_down(level.on_input, steps[at(below)]);
    }
    return hierarchy;
}

} // namespace plisse
