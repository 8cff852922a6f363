#include "saved_run.h"

#include <algorithm>
#include <fstream>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/base/error.h>
#include <plisse/mesh/read_mesh.h>

namespace plisse {

namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

Json read_json_object(const fs::path& path) {
    std::ifstream file(path);
    Json json = Json::parse(file, nullptr, false);
    if (!json.is_object())
        throw InputError(path.string(), "it is missing or damaged", "give the output folder of a run");
    return json;
}

/// The lines up to the first damaged one: a run that was killed may leave its last line torn.
std::vector<SavedFrame> read_index(const fs::path& folder) {
    std::vector<SavedFrame> frames;
    std::ifstream lines(folder / "frames" / "index.jsonl");
    for (std::string line; std::getline(lines, line);) {
        const Json json = Json::parse(line, nullptr, false);
        if (!json.is_object())
            break;
        frames.push_back({json.value("level", 0), json.value("frame", 0), json.value("t", 0.0), json.value("phase", ""),
                          folder / json.value("file", "")});
    }
    return frames;
}

std::vector<std::string> read_body_names(const Json& scene) {
    std::vector<std::string> names;
    for (const char* kind : {"bodies", "obstacles"})
        for (const Json& body : scene.value(kind, Json::array()))
            names.push_back(body.value("name", fmt::format("body {}", names.size())));
    return names;
}

/// Level and time of final.ply: those of the last frame, or of the report when no frames were saved.
std::optional<SavedFrame> find_final(const fs::path& folder, const std::vector<SavedFrame>& frames) {
    SavedFrame last{0, 0, 0, "final", folder / "final.ply"};
    if (!fs::exists(last.file))
        return std::nullopt;
    if (!frames.empty()) {
        last.level = frames.back().level;
        last.t = frames.back().t;
    } else {
        const Json levels = read_json_object(folder / "report.json").value("levels", Json::array());
        if (!levels.empty())
            last.level = levels.back().value("level", 0);
    }
    return last;
}

} // namespace

const SavedFrame* SavedRun::last_frame(int level, int number, const std::string& phase) const {
    for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame)
        if ((level < 0 || frame->level == level) && (number < 0 || frame->number == number) &&
            (phase.empty() || frame->phase == phase))
            return &*frame;
    return nullptr;
}

int SavedRun::finest_level() const {
    int finest = final_state ? final_state->level : 0;
    for (const SavedFrame& frame : frames)
        finest = std::max(finest, frame.level);
    return finest;
}

fs::path SavedRun::rest_file(int level) const {
    return folder / "levels" / fmt::format("{}.ply", level);
}

SavedRun open_run(const fs::path& folder) {
    const fs::path scene_file = folder / "scene.json";
    try {
        const Json scene = read_json_object(scene_file);
        SavedRun run;
        run.folder = folder;
        run.name = scene.value("name", folder.filename().string());
        run.body_count = static_cast<int>(scene.at("bodies").size());
        run.body_names = read_body_names(scene);
        run.frames = read_index(folder);
        run.final_state = find_final(folder, run.frames);
        return run;
    } catch (const Json::exception& error) {
        throw InputError(folder.string(), std::string("its files are damaged: ") + error.what(), "run the scene again");
    }
}

BodyMesh read_body_mesh(const fs::path& path) {
    BodyMesh result{read_mesh(path).mesh, {}};
    result.face_body.assign(result.mesh.faces.size(), 0);
    for (const MeshAttribute& attribute : result.mesh.attributes)
        if (attribute.name == "body" && attribute.domain == MeshAttribute::Domain::face && attribute.width == 1)
            for (std::size_t f = 0; f < result.face_body.size(); ++f)
                result.face_body[f] = std::max(0, static_cast<int>(attribute.values[f]));
    return result;
}

} // namespace plisse
