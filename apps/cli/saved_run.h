#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <plisse/mesh/triangle_mesh.h>

namespace plisse {

/// A line of frames/index.jsonl.
struct SavedFrame {
    int level = 0, number = 0;
    double t = 0; ///< s
    std::string phase;
    std::filesystem::path file;
};

/// What pictures and exports need to know of a run's output folder.
struct SavedRun {
    std::filesystem::path folder;
    std::string name;
    int body_count = 0;                    ///< the frames' bodies from this number on are obstacles
    std::vector<std::string> body_names;   ///< of bodies, then of obstacles: what the frames' bodies are called
    std::vector<SavedFrame> frames;        ///< as they were saved
    std::optional<SavedFrame> final_state; ///< final.ply, where there is one

    /// The last frame that matches; null when none does. Levels and numbers below 0 match all.
    const SavedFrame* last_frame(int level, int number, const std::string& phase) const;
    int finest_level() const;
    std::filesystem::path rest_file(int level) const;
};

/// Reads a run's output folder. Throws InputError when it is not one.
SavedRun open_run(const std::filesystem::path& folder);

/// A mesh with the body of every face, from its face property "body"; 0 for all where it has none.
struct BodyMesh {
    TriangleMesh mesh;
    std::vector<int> face_body;
};

/// Throws InputError as read_mesh does.
BodyMesh read_body_mesh(const std::filesystem::path& path);

} // namespace plisse
