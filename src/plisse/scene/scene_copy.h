#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <plisse/scene/scene.h>

namespace plisse {

/// A scene made fit to move: its mesh files as bytes, and the scene naming them by their places in the copy.
struct SceneCopy {
    struct MeshBytes {
        std::string file; ///< relative to the copy's folder: "meshes/cloth.obj"
        std::string bytes;
    };
    Scene scene;
    std::vector<MeshBytes> meshes;

    /// The text of the copy's scene.json, with the hash of every mesh: equal texts mean equal runs.
    std::string text() const;
};

/// Whether a place in the copy's folder, such as "meshes/cloth.obj", holds something other than these bytes.
using IsTaken = std::function<bool(const std::string& file, const std::string& bytes)>;

/// "meshes/" and the file's own name, with a number where that is taken.
std::string free_mesh_place(const std::filesystem::path& name, const std::string& bytes, const IsTaken& is_taken);

/// Reads every mesh file the scene names. Throws InputError for one that cannot be read. is_taken: for a folder that
/// holds other files already.
SceneCopy copy_scene(const Scene& scene, const IsTaken& is_taken = nullptr);

} // namespace plisse
