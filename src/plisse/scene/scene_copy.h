#pragma once

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

/// Reads every mesh file the scene names. Throws InputError for one that cannot be read.
SceneCopy copy_scene(const Scene& scene);

} // namespace plisse
