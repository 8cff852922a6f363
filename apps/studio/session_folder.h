#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <plisse/scene/scene.h>
#include <plisse/scene/scene_copy.h>
#include <plisse/steer/edit_log.h>

namespace plisse::studio {

/// Where a session keeps what it saves, for pages to download: scenes, edit logs, exports; in meshes/ the meshes of its
/// scenes. Nothing outside is read or written. Made when something is first kept.
class SessionFolder {
public:
    explicit SessionFolder(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Writes NAME.json, a scene that names the edit log NAME.edits.json beside it, and copies of its meshes. name: a
    /// plain one. Returns the names of the two files.
    std::vector<std::string> save(const std::string& name, const Scene& first_scene, const EditLog& edits) const;
    /// The edit log alone.
    void save_edits(const std::string& name, const EditLog& edits) const;
    /// Keeps a mesh that was sent; returns its path relative to the folder. Where another mesh has the name, it gets a
    /// number.
    std::string keep_mesh(const std::string& name, const std::string& bytes) const;

    /// The folder, made if it is not there.
    std::filesystem::path files() const;
    /// A file for download; an empty path when there is none of this name.
    std::filesystem::path file(const std::string& name) const;
    /// [{"name": ..., "bytes": ...}, ...], sorted by name.
    std::string list() const;

private:
    IsTaken is_taken() const;

    std::filesystem::path folder_;
};

} // namespace plisse::studio
