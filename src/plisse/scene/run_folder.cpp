#include <plisse/scene/run_folder.h>

#include <algorithm>
#include <set>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/decimate/level_attributes.h>
#include <plisse/mesh/write_ply.h>
#include <plisse/scene/whole_file.h>

namespace plisse {

namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr const char* coarseness_name = "coarseness";

constexpr std::array written_entries = {"scene.json", "meshes",      "levels",     "frames",
                                        "final.ply",  "report.json", "checkpoint", "log.jsonl"};

void remove_run(const fs::path& folder) {
    for (const char* entry : written_entries)
        fs::remove_all(folder / entry);
}

std::string frame_file(int level, int number) {
    return fmt::format("frames/{}/{:06}.ply", level, number);
}

} // namespace

RunFolder::RunFolder(fs::path folder, const Scene& scene, std::vector<MeshAttribute> attributes,
                     const RunFolderOptions& options)
    : folder_(std::move(folder)), options_(options), attributes_(std::move(attributes)),
      checkpoints_(folder_ / "checkpoint") {
    // These properties of frames are our own; a mesh that was once a frame brings older ones.
    std::erase_if(attributes_, [](const MeshAttribute& attribute) {
        return (attribute.name == "body" && attribute.domain == MeshAttribute::Domain::face) ||
               (attribute.name == coarseness_name && attribute.domain == MeshAttribute::Domain::vertex);
    });
    try {
        open(scene);
    } catch (const fs::filesystem_error& error) {
        throw InputError(folder_.string(), error.code().message(), "give a folder that can be made and written to");
    }
}

void RunFolder::open(const Scene& scene) {
    using Existing = RunFolderOptions::Existing;
    const SceneCopy copy = copy_scene(scene); // before anything is removed: the meshes may lie in this very folder
    const std::string text = copy.text();
    const bool exists = fs::exists(folder_);
    if (exists && !fs::is_directory(folder_))
        throw InputError(folder_.string(), "this is a file", "give the name of a folder");
    if (exists && options_.existing == Existing::refuse)
        throw InputError(folder_.string(), "the folder exists already",
                         "give another one, or --overwrite, or --resume");
    made_folder_ = !exists;
    if (options_.existing != Existing::resume || !open_to_resume(text))
        begin(copy, text);
}

void RunFolder::begin(const SceneCopy& copy, const std::string& scene_text) {
    remove_run(folder_);
    for (const char* part : {"meshes", "frames", "checkpoint"})
        fs::create_directories(folder_ / part);
    for (const SceneCopy::MeshBytes& mesh : copy.meshes)
        write_file_atomically(folder_ / mesh.file, mesh.bytes);
    write_file_atomically(folder_ / "scene.json", scene_text);
    log_ = JsonLines(folder_ / "log.jsonl", 0);
    index_ = JsonLines(folder_ / "frames/index.jsonl", 0);
}

bool RunFolder::open_to_resume(const std::string& scene_text) {
    const fs::path scene = folder_ / "scene.json";
    if (fs::exists(scene) && read_bytes(scene) != scene_text)
        throw InputError(scene.string(), "this is the run of another scene, of other meshes or of other options",
                         "give the scene and options it was begun with, or --overwrite");
    std::optional<SavedCheckpoint> saved = checkpoints_.load();
    if (!saved)
        return false;
    log_ = JsonLines(folder_ / "log.jsonl", saved->log_bytes);
    index_ = JsonLines(folder_ / "frames/index.jsonl", saved->index_bytes);
    checkpoint_ = std::move(saved->checkpoint);
    last_report_ = checkpoint_->report;
    remove_frames_past_index();
    return true;
}

void RunFolder::remove_frames_past_index() {
    std::set<fs::path> listed{folder_ / "frames/index.jsonl"};
    std::ifstream lines(folder_ / "frames/index.jsonl");
    for (std::string line; std::getline(lines, line);)
        listed.insert(folder_ / Json::parse(line).at("file").get<std::string>());
    std::vector<fs::path> stale;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "frames"))
        if (entry.is_regular_file() && !listed.contains(entry.path()))
            stale.push_back(entry.path());
    for (const fs::path& path : stale)
        fs::remove(path);
}

void RunFolder::on_hierarchy(const Hierarchy& hierarchy) {
    levels_.clear();
    for (const HierarchyLevel& level : hierarchy.levels) {
        Surface& surface = levels_.emplace_back();
        surface.rest = level.rest;
        surface.mesh.positions = level.rest;
        surface.mesh.faces = level.faces;
        for (const Face& face : level.faces)
            surface.face_body.push_back(level.part[static_cast<std::size_t>(face[0])]);
        fs::create_directories(folder_ / fmt::format("frames/{}", levels_.size() - 1));
    }
    for (std::size_t level = 0; level < levels_.size(); ++level)
        levels_[level].mesh.attributes = attributes_on(hierarchy, static_cast<int>(level), attributes_);
    fs::create_directories(folder_ / "levels");
    for (std::size_t level = 0; level < levels_.size(); ++level) {
        Surface& surface = levels_[level];
        write_ply(folder_ / fmt::format("levels/{}.ply", level), surface.mesh, surface.face_body);
        surface.mesh.attributes.push_back({coarseness_name, MeshAttribute::Domain::vertex, 1, {}});
    }
}

void RunFolder::on_iteration(const IterationRecord& record) {
    Json line = {{"level", record.level},
                 {"step", record.step},
                 {"iteration", record.iteration},
                 {"t", record.t},
                 {"energy", record.energy},
                 {"step_norm", record.step_norm},
                 {"step_length", record.step_length},
                 {"gap", record.gap},
                 {"seconds", record.seconds}};
    if (!record.limit.cause.empty())
        line["cut_by"] = {{"cause", record.limit.cause}, {"detail", record.limit.detail}};
    log_.append(line);
}

void RunFolder::on_stiffening(const StiffeningRecord& record) {
    log_.append({{"level", record.level},
                 {"step", record.step},
                 {"t", record.t},
                 {"stiffness_factor", record.factor},
                 {"gap_share", record.gap_share},
                 {"pair", record.pair},
                 {"seconds", record.seconds}});
}

void RunFolder::on_frame(const Frame& frame) {
    if (!options_.frames)
        return;
    const std::string file = frame_file(frame.level, frame.number);
    write_surface(folder_ / file, frame.level, *frame.positions);
    index_.append(
        {{"level", frame.level}, {"frame", frame.number}, {"t", frame.t}, {"phase", frame.phase}, {"file", file}});
}

void RunFolder::on_checkpoint(const Checkpoint& checkpoint) {
    last_report_ = checkpoint.report;
    checkpoints_.save({checkpoint, log_.flush(), index_.flush()});
}

void RunFolder::on_report(const RunReport& report) {
    last_report_ = report;
    const ProcessFacts process{options_.version, options_.threads, peak_memory_bytes()};
    write_file_atomically(folder_ / "report.json", report_to_json(report, process).dump(2) + "\n");
    index_.flush();
}

void RunFolder::write_final(int level, const Positions& positions) {
    write_surface(folder_ / "final.ply", level, positions);
}

void RunFolder::write_surface(const fs::path& path, int level, const Positions& positions) {
    Surface& surface = levels_.at(static_cast<std::size_t>(level));
    surface.mesh.positions = positions;
    const VecX values = coarseness(surface.rest, positions, surface.mesh.faces);
    surface.mesh.attributes.back().values.assign(values.begin(), values.end());
    write_ply(path, surface.mesh, surface.face_body);
}

void RunFolder::record_failure(const std::string& message) noexcept {
    try {
        RunReport report = last_report_;
        report.status = RunStatus::failed;
        report.message = message;
        on_report(report);
    } catch (const std::exception&) { // such as the full disk that made the run fail
    }
}

void RunFolder::discard() {
    if (checkpoint_)
        return;
    remove_run(folder_);
    if (made_folder_)
        fs::remove(folder_);
}

} // namespace plisse
