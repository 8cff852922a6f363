// What decimation makes of meshes: of the generators' and of those given, to 4 and to 6 levels on one thread.
//     compare_hierarchies [MESH...]

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <plisse/base/error.h>
#include <plisse/base/parallel.h>
#include <plisse/decimate/decimate.h>
#include <plisse/decimate/hierarchy_statistics.h>
#include <plisse/mesh/check_mesh.h>
#include <plisse/mesh/generate.h>
#include <plisse/mesh/read_mesh.h>
#include <plisse/scene/verify_hierarchy.h>

namespace plisse::comparisons {

namespace {

constexpr int coarsest_vertices = 300;
constexpr const char* columns[] = {"mesh",
                                   "s",
                                   "vertices a second",
                                   "vertices, level by level",
                                   "median quality",
                                   "worst quality",
                                   "Hausdorff, % of the diagonal",
                                   "faces folded",
                                   "rest off",
                                   "there and back, %",
                                   "new intersections",
                                   "holds"};

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

std::vector<NamedMesh> generated() {
    constexpr std::pair<const char*, GeneratorShape> shapes[] = {
        {"sheet", GeneratorShape::sheet},     {"box", GeneratorShape::box},
        {"sphere", GeneratorShape::sphere},   {"cylinder", GeneratorShape::cylinder},
        {"dome", GeneratorShape::dome},       {"torus", GeneratorShape::torus},
        {"annulus", GeneratorShape::annulus}, {"pumpkin", GeneratorShape::pumpkin},
        {"star", GeneratorShape::star}};
    std::vector<NamedMesh> meshes;
    for (const auto& [name, shape] : shapes) {
        GeneratorOptions options;
        options.shape = shape;
        options.edge_length = shape == GeneratorShape::box ? 0.025 : 0.015;
        meshes.push_back({name, generate_mesh(options)});
    }
    return meshes;
}

template <typename Value>
std::string level_by_level(const std::vector<Value>& values, const char* format) {
    std::string text;
    for (const Value& value : values)
        text += (text.empty() ? "" : " / ") + fmt::format(fmt::runtime(format), value);
    return text;
}

void print_row(const NamedMesh& named, int levels) {
    const std::vector<int> part(static_cast<std::size_t>(named.mesh.vertex_count()), 0);
    DecimationOptions options;
    options.levels = levels;
    options.coarsest_vertices = coarsest_vertices;
    DecimationSummary summary;
    const Hierarchy hierarchy =
        decimate({named.mesh.positions, named.mesh.faces, part, {}, {}}, options, nullptr, &summary);
    std::vector<int> vertices;
    std::vector<double> medians, worst, distances;
    for (const LevelStatistics& level : hierarchy_statistics(hierarchy)) {
        vertices.push_back(level.topology.vertices);
        medians.push_back(level.median_quality);
        worst.push_back(level.worst_quality);
    }
    double rest_error = 0, return_error = 0;
    int folded = 0, intersections = 0;
    bool holds = summary.topology_kept && summary.location_errors == 0;
    for (const LevelVerification& level : verify_hierarchy(hierarchy)) {
        distances.push_back(100 * level.distance);
        rest_error = std::max(rest_error, level.rest_error);
        return_error = std::max(return_error, 100 * level.mean_return_error);
        folded += level.folded_faces;
        intersections += level.new_intersections;
        holds = holds && level.holds();
    }
    fmt::print("| {} | {:.2f} | {:.0f} | {}{} | {} | {} | {} | {} | {:.0e} | {:.2g} | {} | {} |\n", named.name,
               summary.total_seconds, named.mesh.vertex_count() / summary.total_seconds, level_by_level(vertices, "{}"),
               summary.ran_dry ? " (no coarser)" : "", level_by_level(medians, "{:.2f}"),
               level_by_level(worst, "{:.2f}"), level_by_level(distances, "{:.2g}"), folded, rest_error, return_error,
               intersections, holds ? "yes" : "NO");
    std::fflush(stdout);
}

/// Nothing for a mesh that cannot be decimated, which is said.
std::vector<NamedMesh> read(const std::string& file) {
    NamedMesh named{std::filesystem::path(file).stem().string(), read_mesh(file).mesh};
    MeshCheck check = check_mesh(named.mesh);
    check.intersecting_faces.clear(); // decimation adds none
    if (check.usable())
        return {named};
    fmt::print(stderr, "{}: left out: {}\n", file, fmt::join(describe_findings(check, named.mesh), ", "));
    return {};
}

std::string rule() {
    std::string text = "|";
    for ([[maybe_unused]] const char* column : columns)
        text += " --- |";
    return text;
}

void compare(const std::vector<std::string>& files) {
    const ThreadLimit one_thread(1);
    std::vector<NamedMesh> meshes = generated();
    for (const std::string& file : files)
        for (NamedMesh& named : read(file))
            meshes.push_back(std::move(named));
    for (const int levels : {4, 6}) {
        fmt::print("\n{} levels:\n\n| {} |\n{}\n", levels, fmt::join(columns, " | "), rule());
        for (const NamedMesh& named : meshes)
            print_row(named, levels);
    }
}

} // namespace

} // namespace plisse::comparisons

int main(int argc, char** argv) {
    try {
        plisse::comparisons::compare({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        fmt::print(stderr, "compare_hierarchies: {}\n", error.what());
        return 2;
    }
    return 0;
}
