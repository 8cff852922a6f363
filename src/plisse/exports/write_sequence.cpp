#include <plisse/exports/write_sequence.h>

#include <plisse/exports/numbered_files.h>
#include <plisse/exports/unfinished_files.h>
#include <plisse/exports/write_obj.h>
#include <plisse/mesh/write_ply.h>

namespace plisse {

namespace {

template <typename WriteState>
void write_sequence(const std::filesystem::path& folder, const Animation& animation, const std::string& extension,
                    const WriteState& write_state) {
    const std::string name = folder.filename().string();
    expect_own_folder(folder, name, extension);
    UnfinishedFiles unfinished;
    const std::filesystem::path unfinished_folder = unfinished.add_folder(folder);
    for (std::size_t k = 0; k < animation.size(); ++k)
        write_state(unfinished_folder / numbered_file(name, k, extension), animation.state(k));
    unfinished.finish();
}

} // namespace

void write_obj_sequence(const std::filesystem::path& folder, const Animation& animation) {
    write_sequence(folder, animation, ".obj", [&](const std::filesystem::path& path, const TriangleMesh& state) {
        write_obj(path, state, animation.face_part, animation.parts);
    });
}

void write_ply_sequence(const std::filesystem::path& folder, const Animation& animation) {
    write_sequence(folder, animation, ".ply", [&](const std::filesystem::path& path, const TriangleMesh& state) {
        write_ply(path, state, animation.face_part);
    });
}

} // namespace plisse
