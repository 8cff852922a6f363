#include <plisse/scene/scene_copy.h>

#include <algorithm>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/scene/whole_file.h>
#include <plisse/scene/write_scene.h>

namespace plisse {

namespace {

/// The place of a file in the copy: its own name, with a number when other contents have taken that.
std::string place_for(const std::filesystem::path& path, const std::string& bytes,
                      std::vector<SceneCopy::MeshBytes>& meshes) {
    for (int number = 1;; ++number) {
        const std::string suffix = number > 1 ? fmt::format("-{}", number) : "";
        const std::string file = "meshes/" + path.stem().string() + suffix + path.extension().string();
        const auto taken =
            std::find_if(meshes.begin(), meshes.end(), [&](const auto& mesh) { return mesh.file == file; });
        if (taken == meshes.end()) {
            meshes.push_back({file, bytes});
            return file;
        }
        if (taken->bytes == bytes)
            return file;
    }
}

} // namespace

SceneCopy copy_scene(const Scene& scene) {
    SceneCopy copy{scene, {}};
    const auto take = [&](MeshSpec& spec) {
        if (!spec.is_file())
            return;
        const std::filesystem::path path = scene.folder / spec.file;
        spec.file = place_for(path, read_bytes(path), copy.meshes);
    };
    for (BodySpec& body : copy.scene.bodies) {
        take(body.mesh);
        if (body.rest.kind == RestSpec::Kind::mesh)
            take(body.rest.mesh);
        if (body.start)
            take(*body.start);
    }
    for (ObstacleSpec& obstacle : copy.scene.obstacles)
        take(obstacle.mesh);
    if (copy.scene.edits)
        copy.scene.edits = place_for(scene.folder / *scene.edits, read_bytes(scene.folder / *scene.edits), copy.meshes);
    return copy;
}

std::string SceneCopy::text() const {
    nlohmann::ordered_json json = scene_to_json(scene);
    for (const MeshBytes& mesh : meshes)
        json["x-mesh-hashes"][mesh.file] = "fnv1a64:" + fnv1a64(mesh.bytes);
    return json.dump(2) + "\n";
}

} // namespace plisse
