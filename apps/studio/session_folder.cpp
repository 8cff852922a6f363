#include "session_folder.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include <plisse/scene/scene_copy.h>
#include <plisse/scene/whole_file.h>

#include "commands.h"

namespace plisse::studio {

namespace fs = std::filesystem;

std::vector<std::string> SessionFolder::save(const std::string& name, const Scene& first_scene,
                                             const EditLog& edits) const {
    SceneCopy copy = copy_scene(first_scene);
    fs::create_directories(files() / "meshes");
    for (const SceneCopy::MeshBytes& mesh : copy.meshes)
        write_file_atomically(files() / mesh.file, mesh.bytes);
    std::vector<std::string> names{name + ".json", name + ".edits.json"};
    write_file_atomically(files() / names[1], edit_log_text(edits));
    copy.scene.edits = names[1];
    write_file_atomically(files() / names[0], copy.text());
    return names;
}

std::string SessionFolder::keep_mesh(const std::string& name, const std::string& bytes) const {
    fs::create_directories(files() / "meshes");
    write_file_atomically(files() / "meshes" / name, bytes);
    return "meshes/" + name;
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
