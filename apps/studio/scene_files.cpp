#include "scene_files.h"

#include <plisse/base/error.h>

namespace plisse::studio {

namespace {

bool stays_in_folder(const std::string& file) {
    const std::filesystem::path path = std::filesystem::path(file).lexically_normal();
    return path.is_relative() && path.begin() != path.end() && *path.begin() != "..";
}

} // namespace

std::set<std::string> files_of(const Scene& scene) {
    std::set<std::string> files;
    const auto add = [&](const MeshSpec& mesh) {
        if (mesh.is_file())
            files.insert(mesh.file);
    };
    for (const BodySpec& body : scene.bodies) {
        add(body.mesh);
        if (body.rest.kind == RestSpec::Kind::mesh)
            add(body.rest.mesh);
        if (body.start)
            add(*body.start);
    }
    for (const ObstacleSpec& obstacle : scene.obstacles)
        add(obstacle.mesh);
    if (scene.edits)
        files.insert(*scene.edits);
    return files;
}

void expect_no_other_files(const Scene& scene, const std::set<std::string>& known,
                           const std::filesystem::path& session_folder) {
    const bool is_of_session = scene.folder == session_folder;
    for (const std::string& file : files_of(scene))
        if (!known.contains(file) && !(is_of_session && stays_in_folder(file)))
            throw InputError(file, "a page cannot name files outside of the session's folder",
                             "drop the mesh on the page, or open the scene from the command line");
}

} // namespace plisse::studio
