#include <plisse/scene/scene_copy.h>

#include <algorithm>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/scene/whole_file.h>
#include <plisse/scene/write_scene.h>

namespace plisse {

std::string free_mesh_place(const std::filesystem::path& name, const std::string& bytes, const IsTaken& is_taken) {
    for (int number = 1;; ++number) {
        const std::string suffix = number > 1 ? fmt::format("-{}", number) : "";
        const std::string file = "meshes/" + name.stem().string() + suffix + name.extension().string();
        if (!is_taken(file, bytes))
            return file;
    }
}

SceneCopy copy_scene(const Scene& scene, const IsTaken& is_taken) {
    SceneCopy copy{scene, {}};
    const auto find = [&](const std::string& file) {
        return std::find_if(copy.meshes.begin(), copy.meshes.end(),
                            [&](const auto& mesh) { return mesh.file == file; });
    };
    const auto place_for = [&](const std::string& source) {
        const std::string bytes = read_bytes(scene.folder / source);
        const std::string file = free_mesh_place(source, bytes, [&](const std::string& place, const std::string&) {
            const auto taken = find(place);
            return (taken != copy.meshes.end() && taken->bytes != bytes) || (is_taken && is_taken(place, bytes));
        });
        if (find(file) == copy.meshes.end())
            copy.meshes.push_back({file, bytes});
        return file;
    };
    const auto take = [&](MeshSpec& spec) {
        if (spec.is_file())
            spec.file = place_for(spec.file);
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
        copy.scene.edits = place_for(*scene.edits);
    return copy;
}

std::string SceneCopy::text() const {
    nlohmann::ordered_json json = scene_to_json(scene);
    for (const MeshBytes& mesh : meshes)
        json["x-mesh-hashes"][mesh.file] = "fnv1a64:" + fnv1a64(mesh.bytes);
    return json.dump(2) + "\n";
}

} // namespace plisse
