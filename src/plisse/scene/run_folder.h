#pragma once

#include <filesystem>
#include <optional>

#include <plisse/drive/recorder.h>
#include <plisse/mesh/triangle_mesh.h>
#include <plisse/scene/checkpoint_folder.h>
#include <plisse/scene/json_lines.h>
#include <plisse/scene/report_json.h>
#include <plisse/scene/scene_copy.h>

namespace plisse {

struct RunFolderOptions {
    enum class Existing { refuse, overwrite, resume };
    Existing existing = Existing::refuse; ///< what to do with a folder that exists
    bool frames = true;                   ///< whether frames are saved (final.ply always is)
    std::string version;                  ///< as report.json names it
    int threads = 1;
};

/// The output folder of a run, as CONTRACT.md lays it out:
///   scene.json, meshes/      the scene as understood and copies of its meshes
///   frames/L/NNNNNN.ply      frames of level L, with the vertex property "coarseness"; frames/index.jsonl lists them
///   final.ply, report.json, log.jsonl, checkpoint/
/// Files that grow are cut back to the checkpoint on resuming; all others are replaced in one step, so a process killed
/// at any moment leaves a folder that can be resumed.
class RunFolder final : public Recorder {
public:
    /// Makes or opens the folder. attributes: of the finest mesh, for frames. Throws InputError when it exists and that
    /// is refused, or when what is to be resumed is the run of another scene.
    RunFolder(std::filesystem::path folder, const Scene& scene, std::vector<MeshAttribute> attributes,
              const RunFolderOptions& options);

    /// The checkpoint to go on from; nothing when the run begins at its beginning.
    const std::optional<Checkpoint>& checkpoint() const { return checkpoint_; }

    void on_hierarchy(const Hierarchy& hierarchy) override;
    void on_iteration(const IterationRecord& record) override;
    void on_stiffening(const StiffeningRecord& record) override;
    void on_frame(const Frame& frame) override;
    void on_checkpoint(const Checkpoint& checkpoint) override;
    void on_report(const RunReport& report) override;

    /// Writes final.ply: the state of a level, after on_hierarchy.
    void write_final(int level, const Positions& positions);

    /// Writes the last known report as that of a run that failed. For use while an exception is on its way: what cannot
    /// be written is left.
    void record_failure(const std::string& message) noexcept;

    /// Takes away everything this object has written, for a run that turned out impossible. A resumed one is left.
    void discard();

private:
    struct Surface {
        Positions rest;
        TriangleMesh mesh; ///< its last attribute is the coarseness
        std::vector<int> face_body;
    };
    void open(const Scene& scene);
    void begin(const SceneCopy& copy, const std::string& scene_text);
    bool open_to_resume(const std::string& scene_text);
    void remove_frames_past_index();
    void write_surface(const std::filesystem::path& path, int level, const Positions& positions);

    std::filesystem::path folder_;
    RunFolderOptions options_;
    std::vector<MeshAttribute> attributes_; ///< of the finest mesh
    std::vector<Surface> levels_;
    CheckpointFolder checkpoints_;
    std::optional<Checkpoint> checkpoint_;
    JsonLines log_, index_;
    RunReport last_report_;
    bool made_folder_ = false;
};

} // namespace plisse
