#pragma once

#include <vector>

#include <plisse/decimate/decimate.h>
#include <plisse/decimate/dynamic_faces.h>

namespace plisse {

/// What decimation knows of a vertex for as long as its id lives.
struct VertexState {
    int part = 0;
    int label = -1;             ///< handle; such a vertex keeps its place
    int group = -1;             ///< queue it is decimated with; -1: not at all
    bool on_curve = false;      ///< at an edge that bounds sheets: on the boundary, or where more than two faces meet
    bool joint = false;         ///< at an edge of more than two faces
    bool corner = false;        ///< where curves meet, end or turn sharply; keeps its place
    bool handle_border = false; ///< has neighbours of another label
    bool locked = false; ///< at a face without area, a pinch or faces turned opposite ways: no edge of it collapses

    bool pinned() const { return corner || label >= 0; }
    /// How much shape a pinned vertex holds: of two that merge, the higher rank keeps its place.
    int rank() const { return 4 * corner + 2 * on_curve + handle_border; }
};

/// States of the input's vertices. Group 0 holds the parts that are no obstacles, then comes a group for each obstacle
/// that is decimated.
std::vector<VertexState> vertex_states(const DecimationInput& input, const DecimationOptions& options,
                                       const DynamicFaces& faces);

} // namespace plisse
