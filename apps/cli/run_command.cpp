#include "run_command.h"

#include <cmath>
#include <filesystem>
#include <memory>
#include <variant>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/base/parallel.h>
#include <plisse/drive/multiscale.h>
#include <plisse/drive/run.h>
#include <plisse/mesh/intersecting_surfaces.h>
#include <plisse/mesh/write_ply.h>
#include <plisse/scene/build_model.h>
#include <plisse/scene/build_subdivision_model.h>
#include <plisse/scene/hierarchy_cache.h>
#include <plisse/scene/overrides.h>
#include <plisse/scene/read_scene.h>
#include <plisse/scene/run_folder.h>
#include <plisse/steer/replay.h>

#include "console.h"
#include "exit_status.h"
#include "interrupt.h"
#include "report_table.h"

namespace plisse {

namespace {

struct RunArguments {
    std::string scene, folder, progress = "auto";
    std::optional<std::string> method;
    std::optional<int> level;
    std::optional<double> until;
    int threads = 0;
    bool resume = false, no_frames = false, quiet = false, overwrite = false, no_cache = false;
};

RunFolderOptions folder_options(const RunArguments& arguments, int threads) {
    using Existing = RunFolderOptions::Existing;
    const Existing existing = arguments.resume      ? Existing::resume
                              : arguments.overwrite ? Existing::overwrite
                                                    : Existing::refuse;
    return {existing, !arguments.no_frames, PLISSE_VERSION, threads};
}

/// A scene made ready to run by its method.
using ReadyModel = std::variant<Model, SubdivisionModel>;

ReadyModel make_ready(const Scene& scene, Context& context) {
    if (scene.solve.method == Method::rmtr)
        return build_subdivision_model(scene, context);
    return build_model(scene, context);
}

const std::vector<MeshAttribute>& attributes_of(const ReadyModel& ready) {
    if (const Model* model = std::get_if<Model>(&ready))
        return model->mesh.attributes;
    return std::get<SubdivisionModel>(ready).surface.attributes;
}

RunResult run_ready(const Scene& scene, const ReadyModel& ready, const RunOptions& options, Recorder& recorder,
                    Context& context) {
    if (scene.edits)
        return replay(scene, read_edit_log(scene.folder / *scene.edits), options, recorder, context);
    if (const Model* model = std::get_if<Model>(&ready))
        return run(*model, options, recorder, context);
    return run_multiscale(std::get<SubdivisionModel>(ready), options, recorder, context);
}

/// Runs into the folder. When that throws, the folder says so, or vanishes when nothing could be begun.
RunResult run_into(RunFolder& folder, const Scene& scene, const ReadyModel& ready, const RunArguments& arguments,
                   Context& context) {
    std::optional<HierarchyCache> cache;
    if (const auto caches = HierarchyCache::default_folder(); caches && !arguments.no_cache)
        cache.emplace(*caches, context);
    const RunOptions options{arguments.until.value_or(-1), folder.checkpoint() ? &*folder.checkpoint() : nullptr,
                             cache ? &*cache : nullptr};
    try {
        RunResult result = run_ready(scene, ready, options, folder, context);
        if (result.positions.cols() > 0)
            folder.write_final(result.level, result.positions);
        folder.on_report(result.report);
        return result;
    } catch (const InputError&) {
        folder.discard();
        throw;
    } catch (const std::exception& error) {
        folder.record_failure(error.what());
        throw;
    }
}

void print_end(const RunArguments& arguments, const StoredReport& stored, ProgressStyle style) {
    if (style == ProgressStyle::json)
        fmt::print("{}\n", report_to_json(stored.report, stored.process).dump());
    else if (style != ProgressStyle::quiet)
        fmt::print("{}\nin {}\n", report_table(stored), arguments.folder);
    std::fflush(stdout);
    if (stored.report.status == RunStatus::interrupted)
        fmt::print(stderr, "plisse: interrupted; to go on: plisse run {} -o {} --resume, with the options as before\n",
                   arguments.scene, arguments.folder);
}

ExitCode exit_code(const RunReport& report) {
    if (report.status == RunStatus::interrupted)
        return ExitCode::interrupted;
    return report.status == RunStatus::converged && report.intersecting_pairs == 0 ? ExitCode::done : ExitCode::failed;
}

/// A mesh next to the results' folder, which a refused run does not leave behind.
std::string intersections_file(std::filesystem::path folder) {
    if (!folder.has_filename())
        folder = folder.parent_path();
    return folder.string() + "_intersections.ply";
}

void run_scene(const RunArguments& arguments) {
    if (arguments.until && !(std::isfinite(*arguments.until) && *arguments.until >= 0))
        throw InputError("--until", "the time is not a number of at least 0", "give seconds of the timeline");
    Scene scene = read_scene(arguments.scene);
    override_solve(scene, arguments.method, arguments.level);

    const ThreadLimit limit(arguments.threads);
    const ProgressStyle style = progress_style(arguments.progress, arguments.quiet);
    Console console(style);
    const InterruptGuard guard(console);
    const ReadyModel ready = make_ready(scene, console);
    RunFolder folder(arguments.folder, scene, attributes_of(ready), folder_options(arguments, limit.threads()));
    if (arguments.resume && !folder.checkpoint())
        console.on_message(fmt::format("{} has no checkpoint: the run begins at its beginning", arguments.folder));

    const RunResult result = run_into(folder, scene, ready, arguments, console);
    console.clear_bar();
    print_end(arguments, {result.report, {PLISSE_VERSION, limit.threads(), peak_memory_bytes()}}, style);
    if (const ExitCode code = exit_code(result.report); code != ExitCode::done)
        throw ExitStatus{code};
}

} // namespace

void add_run_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("run", "Runs a scene");
    auto arguments = std::make_shared<RunArguments>();
    command->add_option("SCENE", arguments->scene, "scene file (JSON)")->required();
    command->add_option("-o,--output", arguments->folder, "folder for the results")->required();
    command->add_option("--method", arguments->method, "progressive, direct or rmtr, instead of the scene's");
    command->add_option("--level", arguments->level, "direct: on this level's own mesh");
    command->add_option("--threads", arguments->threads, "threads; 0: one a processor")->check(CLI::Range(0, 1024));
    command->add_option("--until", arguments->until, "ends the timeline at this time, s");
    CLI::Option* resume = command->add_flag("--resume", arguments->resume, "goes on with an interrupted run");
    command->add_flag("--overwrite", arguments->overwrite, "replaces the run in an existing folder")->excludes(resume);
    command->add_flag("--no-frames", arguments->no_frames, "saves no frames, only the final state");
    command->add_flag("--no-cache", arguments->no_cache,
                      "builds the hierarchy anew, and does not keep it for the next run");
    command->add_flag("--quiet", arguments->quiet, "prints errors only");
    command->add_option("--progress", arguments->progress, "auto, plain or json")
        ->check(CLI::IsMember({"auto", "plain", "json"}));
    command->callback([arguments] {
        try {
            run_scene(*arguments);
        } catch (const IntersectingSurfaces& error) {
            const std::string file = intersections_file(arguments->folder);
            write_ply(file, error.faces(), error.parts());
            throw error.with("and look at the faces that meet in " + file);
        }
    });
}

} // namespace plisse
