#pragma once

#include <span>
#include <vector>

#include <plisse/decimate/hierarchy.h>
#include <plisse/mesh/sheet_graph.h>

namespace plisse {

/// Counts of a mesh that decimation must not change, and others.
struct TopologyCounts {
    int vertices = 0; ///< used by faces
    int faces = 0;
    int euler_characteristic = 0;
    int boundary_loops = 0; ///< connected pieces of the boundary
    int components = 0;
    SheetGraph graph;

    bool same_topology(const TopologyCounts& other) const {
        return euler_characteristic == other.euler_characteristic && boundary_loops == other.boundary_loops &&
               components == other.components && graph == other.graph;
    }
};
TopologyCounts count_topology(int vertex_count, std::span<const Face> faces);

struct LevelStatistics {
    TopologyCounts topology;
    /// q = 4 sqrt(3) area / (sum of squared edges) over the faces: 1 for equilateral triangles.
    double worst_quality = 0, mean_quality = 0, median_quality = 0;
    /// Mean over the finest vertices of |U x_l - x_L|, divided by the diagonal of their bounding box: how far anchors
    /// are from the vertices they stand for.
    double mean_map_error = 0;
    double largest_map_error = 0; ///< likewise
};

/// One for each level.
std::vector<LevelStatistics> hierarchy_statistics(const Hierarchy& hierarchy);

} // namespace plisse
