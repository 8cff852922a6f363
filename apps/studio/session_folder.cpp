#include "session_folder.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include <plisse/scene/scene_copy.h>
#include <plisse/scene/whole_file.h>

#include "commands.h"

namespace plisse::studio {

namespace fs = std::filesystem;

namespace {

std::string edits_name(const std::string& name) {
    return name + ".edits.json";
}

/// Whether there is a file with other bytes.
bool is_other_file(const fs::path& path, const std::string& bytes) {
    if (!fs::exists(fs::symlink_status(path)))
        return false;
    std::ifstream stream(path, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {}) != bytes;
}

} // namespace

std::vector<std::string> SessionFolder::save(const std::string& name, const Scene& first_scene,
                                             const EditLog& edits) const {
    SceneCopy copy = copy_scene(first_scene, is_taken());
    fs::create_directories(files() / "meshes");
    for (const SceneCopy::MeshBytes& mesh : copy.meshes)
        write_file_atomically(files() / mesh.file, mesh.bytes);
    save_edits(name, edits);
    copy.scene.edits = edits_name(name);
    write_file_atomically(files() / (name + ".json"), copy.text());
    return {name + ".json", edits_name(name)};
}

void SessionFolder::save_edits(const std::string& name, const EditLog& edits) const {
    write_file_atomically(files() / edits_name(name), edit_log_text(edits));
}

std::string SessionFolder::keep_mesh(const std::string& name, const std::string& bytes) const {
    const std::string file = free_mesh_place(name, bytes, is_taken());
    fs::create_directories(files() / "meshes");
    write_file_atomically(files() / file, bytes);
    return file;
}

IsTaken SessionFolder::is_taken() const {
    return [this](const std::string& file, const std::string& bytes) { return is_other_file(folder_ / file, bytes); };
}

fs::path SessionFolder::files() const {
    fs::create_directories(folder_);
    return folder_;
}

fs::path SessionFolder::file(const std::string& name) const {
    const fs::path path = folder_ / name;
    return is_plain_name(name) && fs::is_regular_file(fs::symlink_status(path)) ? path : fs::path();
}

std::string SessionFolder::list() const {
    std::vector<fs::path> paths;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder_, none))
        if (entry.is_regular_file() && is_plain_name(entry.path().filename().string()))
            paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const fs::path& path : paths)
        list.push_back({{"name", path.filename().string()}, {"bytes", fs::file_size(path)}});
    return list.dump();
}

} // namespace plisse::studio
