#include <plisse/decimate/hierarchy_statistics.h>

#include <algorithm>
#include <numeric>

#include <plisse/decimate/patch.h>
#include <plisse/spatial/box.h>

namespace plisse {

namespace {

void measure_quality(const HierarchyLevel& level, LevelStatistics& statistics) {
    std::vector<double> qualities;
    for (const Face& face : level.faces)
        qualities.push_back(
            face_shape(level.rest.col(face[0]), level.rest.col(face[1]), level.rest.col(face[2])).quality);
    if (qualities.empty())
        return;
    std::sort(qualities.begin(), qualities.end());
    statistics.worst_quality = qualities.front();
    statistics.median_quality = qualities[qualities.size() / 2];
    statistics.mean_quality =
        std::accumulate(qualities.begin(), qualities.end(), 0.0) / static_cast<double>(qualities.size());
}

void measure_map(const HierarchyLevel& level, const Positions& finest, double diagonal, LevelStatistics& statistics) {
    double sum = 0;
    int count = 0;
    for (std::size_t v = 0; v < level.to_finest.size(); ++v) {
        const Anchor& anchor = level.to_finest[v];
        if (anchor.face < 0)
            continue;
        const Face& face = level.faces[anchor.face];
        const Vec3 mapped = anchor.weights[0] * level.rest.col(face[0]) + anchor.weights[1] * level.rest.col(face[1]) +
                            anchor.weights[2] * level.rest.col(face[2]);
        const double error = (mapped - finest.col(static_cast<Eigen::Index>(v))).norm();
        sum += error;
        statistics.largest_map_error = std::max(statistics.largest_map_error, error / diagonal);
        ++count;
    }
    if (count > 0)
        statistics.mean_map_error = sum / count / diagonal;
}

} // namespace

TopologyCounts count_topology(int vertex_count, std::span<const Face> faces) {
    const Connectivity connectivity(vertex_count, faces);
    const std::vector<int> component = components(vertex_count, faces);
    TopologyCounts counts;
    counts.vertices =
        static_cast<int>(std::count_if(component.begin(), component.end(), [](int number) { return number >= 0; }));
    counts.faces = static_cast<int>(faces.size());
    counts.euler_characteristic = counts.vertices - connectivity.edge_count() + counts.faces;
    counts.boundary_loops = static_cast<int>(boundary_pieces(connectivity).size());
    counts.graph = sheet_graph(connectivity);
    counts.components = component.empty() ? 0 : *std::max_element(component.begin(), component.end()) + 1;
    return counts;
}

std::vector<LevelStatistics> hierarchy_statistics(const Hierarchy& hierarchy) {
    const Positions& finest = hierarchy.finest().rest;
    const double diagonal = bounding_box(finest).diagonal();
    std::vector<LevelStatistics> result;
    for (const HierarchyLevel& level : hierarchy.levels) {
        LevelStatistics& statistics = result.emplace_back();
        statistics.topology = count_topology(static_cast<int>(level.rest.cols()), level.faces);
        measure_quality(level, statistics);
        measure_map(level, finest, diagonal, statistics);
    }
    return result;
}

} // namespace plisse
