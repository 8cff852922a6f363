#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include <plisse/drive/recorder.h>

namespace plisse {

/// A checkpoint with how long the growing files of the run were when it was taken.
struct SavedCheckpoint {
    Checkpoint checkpoint;
    std::uintmax_t log_bytes = 0, index_bytes = 0;
};

/// DIR/checkpoint: two state files (raw numbers: positions, velocities, what contacts remember) used in turn, and
/// manifest.json, which names the good one. The manifest is replaced last and in one step, so a writer killed at any
/// moment leaves either the old checkpoint or the new one.
class CheckpointFolder {
public:
    explicit CheckpointFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Throws std::runtime_error when it cannot be written.
    void save(const SavedCheckpoint& saved);

    /// The last complete checkpoint, exactly as it was saved; nothing when there is none. Throws InputError when it is
    /// damaged.
    std::optional<SavedCheckpoint> load();

private:
    std::filesystem::path folder_;
    int state_in_use_ = 1; ///< number of the state file that the manifest names
};

} // namespace plisse
