#include "hierarchy_command.h"

#include <memory>
#include <optional>

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/base/parallel.h>
#include <plisse/decimate/decimate.h>
#include <plisse/decimate/hierarchy_statistics.h>
#include <plisse/mesh/check_mesh.h>
#include <plisse/mesh/connectivity.h>
#include <plisse/mesh/read_mesh.h>
#include <plisse/model/discretization.h>
#include <plisse/scene/build_model.h>
#include <plisse/scene/hierarchy_cache.h>
#include <plisse/scene/hierarchy_folder.h>
#include <plisse/scene/read_scene.h>
#include <plisse/scene/verify_hierarchy.h>
#include <plisse/scene/whole_file.h>

#include "console.h"
#include "estimate_table.h"
#include "exit_status.h"

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;

struct HierarchyArguments {
    std::string input, folder;
    std::optional<int> levels, coarsest;
    int threads = 0;
    bool verify = false;
};

/// A hierarchy with what is known before any run.
struct Built {
    DecimationResult decimation;
    std::vector<MeshAttribute> attributes; ///< of the finest mesh
    FoldEstimates estimates;
};

/// Intersections stop a run but not a decimation; everything else that check finds does.
TriangleMesh read_decimatable(const std::string& file) {
    MeshFile read = read_mesh(file);
    for (const std::string& note : read.notes)
        fmt::print(stderr, "plisse: {}: {}\n", file, note);
    MeshCheck check = check_mesh(read.mesh);
    if (!check.intersecting_faces.empty())
        fmt::print(stderr, "plisse: {}: {} pairs of faces intersect: a run would refuse this mesh\n", file,
                   check.intersecting_faces.size());
    check.intersecting_faces.clear();
    if (!check.usable())
        throw InputError(file, fmt::format("{}", fmt::join(describe_findings(check, read.mesh), ", ")),
                         "repair the mesh (`plisse check` lists everything)");
    return std::move(read.mesh);
}

Json level_json(int number, const LevelStatistics& s, const DecimationSummary& summary) {
    const auto level = static_cast<std::size_t>(number);
    return {{"level", number},
            {"file", fmt::format("level-{}.ply", number)},
            {"vertices", s.topology.vertices},
            {"faces", s.topology.faces},
            {"wanted_vertices", summary.wanted_vertices.at(level)},
            {"components", s.topology.components},
            {"boundary_loops", s.topology.boundary_loops},
            {"euler_characteristic", s.topology.euler_characteristic},
            {"sheets", s.topology.graph.sheets},
            {"curves", s.topology.graph.curves},
            {"curve_corners", s.topology.graph.corners},
            {"quality", {{"worst", s.worst_quality}, {"mean", s.mean_quality}, {"median", s.median_quality}}},
            {"map_error", {{"mean", s.mean_map_error}, {"largest", s.largest_map_error}}}};
}

Json hierarchy_json(const std::string& input, const std::vector<LevelStatistics>& statistics,
                    const DecimationSummary& summary) {
    Json json = {{"plisse", PLISSE_VERSION}, {"input", input}, {"levels", Json::array()}};
    for (std::size_t l = 0; l < statistics.size(); ++l)
        json["levels"].push_back(level_json(static_cast<int>(l), statistics[l], summary));
    json["ran_dry"] = summary.ran_dry;
    json["topology_kept"] = summary.topology_kept;
    for (int r = 0; r < rejection_count; ++r)
        json["rejections"][rejection_name(static_cast<Rejection>(r))] = summary.rejections[static_cast<std::size_t>(r)];
    json["relocations"] = summary.relocations;
    json["location_errors"] = summary.location_errors;
    json["worst_location"] = summary.worst_location;
    json["seconds"] = {
        {"total", summary.total_seconds}, {"collapse", summary.collapse_seconds}, {"map", summary.map_seconds}};
    return json;
}

Json verification_json(const LevelVerification& v) {
    return {{"level", v.level},
            {"rest_error", v.rest_error},
            {"rigid_error", v.rigid_error},
            {"worst_weight", v.worst_weight},
            {"worst_weight_sum", v.worst_sum},
            {"missing_anchors", v.missing_anchors},
            {"coincident_images", v.coincident_images},
            {"mapped_faces", v.mapped_faces},
            {"folded_faces", v.folded_faces},
            {"missing_ways_back", v.missing_ways_back},
            {"return_error", {{"mean", v.mean_return_error}, {"largest", v.largest_return_error}}},
            {"distance", v.distance},
            {"new_intersections", v.new_intersections},
            {"holds", v.holds()}};
}

void print_levels(const std::vector<LevelStatistics>& statistics, const DecimationSummary& summary) {
    fmt::print("{:>5} {:>9} {:>9} {:>13} {:>14} {:>15}\n", "level", "vertices", "faces", "mean quality",
               "worst quality", "mean map error");
    for (std::size_t l = 0; l < statistics.size(); ++l)
        fmt::print("{:>5} {:>9} {:>9} {:>13.3f} {:>14.3f} {:>15.3g}\n", l, statistics[l].topology.vertices,
                   statistics[l].topology.faces, statistics[l].mean_quality, statistics[l].worst_quality,
                   statistics[l].mean_map_error);
    fmt::print("{:.2f} s, of which the map took {:.2f} s\n", summary.total_seconds, summary.map_seconds);
    if (summary.ran_dry)
        fmt::print("no edge could be collapsed any more before the coarsest size was reached\n");
}

/// Prints the measures; true when they all hold.
bool print_verification(const std::vector<LevelVerification>& verifications, const DecimationSummary& summary) {
    bool holds = summary.location_errors == 0 && summary.topology_kept;
    for (const LevelVerification& v : verifications) {
        fmt::print("level {}: rest recovery error {:.2e} of the diagonal, rigid-motion error {:.2e} of the diagonal\n",
                   v.level, v.rest_error, v.rigid_error);
        fmt::print(
            "  map: smallest weight {:.1e}, sum off by {:.1e}, vertices without anchor {}, coincident images {}, "
            "faces folded {} of {}: {}\n",
            v.worst_weight, v.worst_sum, v.missing_anchors, v.coincident_images, v.folded_faces, v.mapped_faces,
            v.holds() ? "holds" : "does NOT hold");
        fmt::print("  way back: vertices without place {}, there and back off by {:.1e} (mean) and {:.1e} (largest) of "
                   "the diagonal\n  surface: off by {:.2e} of the diagonal (Hausdorff), new intersections {}\n",
                   v.missing_ways_back, v.mean_return_error, v.largest_return_error, v.distance, v.new_intersections);
        holds = holds && v.holds();
    }
    fmt::print("points carried outside their patch: {} (worst {:.1e}), topology {}\n", summary.location_errors,
               summary.worst_location, summary.topology_kept ? "kept" : "NOT kept");
    return holds;
}

/// Of a mesh alone only the shape is known.
Built build_from_mesh(const HierarchyArguments& arguments) {
    TriangleMesh mesh = read_decimatable(arguments.input);
    // Components never merge, so one part is enough.
    const std::vector<int> part(static_cast<std::size_t>(mesh.vertex_count()), 0);
    DecimationOptions options;
    options.levels = arguments.levels.value_or(3);
    options.coarsest_vertices = arguments.coarsest.value_or(500);
    DecimationResult decimation;
    decimation.hierarchy = decimate({mesh.positions, mesh.faces, part, {}, {}}, options, nullptr, &decimation.summary);
    FoldEstimates estimates =
        estimate_folds(decimation.hierarchy, {"the mesh"}, {{shape_scale(mesh.positions, mesh.faces)}});
    return {std::move(decimation), std::move(mesh.attributes), std::move(estimates)};
}

/// As a run of the scene would build it.
Built build_from_scene(const HierarchyArguments& arguments) {
    Scene scene = read_scene(arguments.input);
    scene.hierarchy.levels = arguments.levels.value_or(scene.hierarchy.levels);
    if (arguments.coarsest && scene.hierarchy.source == HierarchySource::loop)
        throw InputError("--coarsest", "the scene's levels are made by subdivision, from its mesh as level 0",
                         "leave it out, or set `source` to \"decimation\"");
    scene.hierarchy.coarsest_vertices = arguments.coarsest.value_or(scene.hierarchy.coarsest_vertices);
    Console console(ProgressStyle::plain);
    const Model model = build_model(scene, console);
    std::optional<HierarchyCache> cache;
    if (const auto folder = HierarchyCache::default_folder())
        cache.emplace(*folder, console);
    const Discretization discretization(model, model.hierarchy.levels, console, cache ? &*cache : nullptr);
    std::vector<std::string> names;
    std::vector<std::vector<FoldScale>> scales;
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
        names.push_back(model.bodies[b].name);
        scales.push_back(fold_scales(model, static_cast<int>(b)));
    }
    return {discretization.decimation(), model.mesh.attributes,
            estimate_folds(discretization.hierarchy(), std::move(names), std::move(scales))};
}

bool is_scene(const std::string& file) {
    return std::filesystem::path(file).extension() == ".json";
}

void build_hierarchy(const HierarchyArguments& arguments) {
    if (arguments.folder.empty() && !is_scene(arguments.input))
        throw InputError("-o", "the folder for the levels is missing", "give one; only a scene can do without");
    const ThreadLimit limit(arguments.threads);
    const Built built = is_scene(arguments.input) ? build_from_scene(arguments) : build_from_mesh(arguments);
    const auto& [hierarchy, summary] = built.decimation;
    const std::vector<LevelStatistics> statistics = hierarchy_statistics(hierarchy);

    Json json = hierarchy_json(arguments.input, statistics, summary);
    add_estimates(built.estimates, json);
    print_levels(statistics, summary);
    fmt::print("{}", estimate_table(built.estimates));
    bool holds = true;
    if (arguments.verify) {
        const std::vector<LevelVerification> verifications = verify_hierarchy(hierarchy);
        for (const LevelVerification& v : verifications)
            json["verification"].push_back(verification_json(v));
        holds = print_verification(verifications, summary);
    }
    if (!arguments.folder.empty()) {
        std::filesystem::create_directories(arguments.folder);
        write_hierarchy(arguments.folder, built.decimation, built.attributes);
        write_file_atomically(std::filesystem::path(arguments.folder) / "hierarchy.json", json.dump(2) + "\n");
    }
    if (!holds)
        throw ExitStatus{ExitCode::failed};
}

} // namespace

void add_hierarchy_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("hierarchy", "Decimates a mesh or a scene into nested levels, and says how coarse is sound");
    auto arguments = std::make_shared<HierarchyArguments>();
    command
        ->add_option(
            "MESH", arguments->input,
            "OBJ, PLY, STL or OFF file, or a scene (JSON), whose bodies and obstacles are decimated as in a run")
        ->required();
    command->add_option("-o,--output", arguments->folder, "folder for the levels and the map; a scene needs none");
    command->add_option("--levels", arguments->levels, "meshes in all, the input included (3, or the scene's)")
        ->check(CLI::Range(1, 20));
    command->add_option("--coarsest", arguments->coarsest, "vertices of level 0 (500, or the scene's)")
        ->check(CLI::Range(4, 1 << 30));
    command->add_option("--threads", arguments->threads, "threads; 0: one a processor")->check(CLI::Range(0, 1024));
    command->add_flag("--verify", arguments->verify,
                      "measures rest-shape recovery, rigid motions and the map's bijectivity");
    command->callback([arguments] { build_hierarchy(*arguments); });
}

} // namespace plisse
