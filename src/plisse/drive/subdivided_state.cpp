#include <plisse/drive/subdivided_state.h>

#include <algorithm>
#include <limits>

#include <plisse/contact/candidates.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/drive/pair_motion.h>
#include <plisse/drive/refinement_targets.h>

namespace plisse {

namespace {

/// The whole mesh moves at once: a finer grain would take a round for each pair that is in the way.
constexpr double grain = 1.0 / 64;

std::vector<MovingPair> pairs_of(const Candidates& candidates) {
    std::vector<MovingPair> pairs;
    for (StencilKind kind : {StencilKind::point_triangle, StencilKind::edge_edge})
        for (int i = 0; i < candidates.size(kind); ++i)
            pairs.push_back({kind, candidates.vertices(kind, i)});
    return pairs;
}

double least_gap(const std::vector<MovingPair>& pairs, const Positions& x) {
    double squared = std::numeric_limits<double>::infinity();
    for (const MovingPair& pair : pairs)
        squared = std::min(squared, squared_distance(pair.kind, gather(x, pair.vertices)));
    return std::sqrt(squared);
}

} // namespace

SubdividedState subdivide_state(const Discretization& discretization, int from, const Positions& x, double t) {
    const Model& model = discretization.model();
    const HierarchyLevel& fine = discretization.mesh(from + 1);
    const Positions targets = refinement_targets(discretization, from, x, t);
    std::vector<std::uint8_t> obstacle;
    for (int part = 0; part < model.part_count(); ++part)
        obstacle.push_back(model.is_obstacle(part));
    const CollisionMesh mesh(fine.rest, fine.faces, fine.part, obstacle);
    const double gap = model.contact.distance + 2 * model.contact.thickness;

    SubdividedState state;
    state.positions = prolongation_to_next(discretization.hierarchy(), from, ProlongationOperator::intrinsic).apply(x);
    state.new_vertices = static_cast<int>(fine.rest.cols() - x.cols());
    Candidates candidates(mesh, gap, true);
    for (double share = 0; share < 1;) { // a way with too many pairs for the memory is gone in parts
        const Positions way = targets - state.positions;
        share = candidates.find_along(state.positions, way, 1);
        const std::vector<MovingPair> pairs = pairs_of(candidates);
        state.stopped_vertices =
            move_apart(state.positions, state.positions + share * way, fine.rest, mesh.vertices, pairs, {gap, grain});
        state.min_gap = least_gap(pairs, state.positions);
    }
    return state;
}

} // namespace plisse
