#include "export_states.h"

#include <stdexcept>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <plisse/decimate/level_attributes.h>

extern char** environ;

namespace plisse::studio {

namespace {

namespace fs = std::filesystem;

/// What the format's main file or folder is called.
std::string main_name(const std::string& name, AnimationFormat format, bool one_state) {
    switch (format) {
    case AnimationFormat::obj:
        return name + (one_state ? ".obj" : "-obj");
    case AnimationFormat::ply:
        return name + (one_state ? ".ply" : "-ply");
    case AnimationFormat::gltf:
        return name + ".glb";
    case AnimationFormat::usd:
        return name + ".usda";
    case AnimationFormat::pvd:
        return name + ".pvd";
    case AnimationFormat::pc2:
        return name + ".pc2";
    }
    throw std::logic_error("no such format");
}

/// States that follow one another at the same time of the timeline are shown one after the other.
std::vector<double> playing_times(const std::vector<Board::SavedFrame>& states, double interval) {
    std::vector<double> times;
    for (const Board::SavedFrame& state : states)
        times.push_back(times.empty() || state.t > times.back() ? state.t : times.back() + interval);
    return times;
}

Animation animation_of(const std::string& name, const Discretization& discretization,
                       const std::vector<Board::SavedFrame>& states) {
    const Model& model = discretization.model();
    const int level = states.front().level;
    Animation animation;
    animation.name = name;
    for (int part = 0; part < model.part_count(); ++part)
        animation.parts.push_back(model.part_name(part));
    animation.face_part = discretization.layout(level).face_part;
    animation.times = playing_times(states, model.solve.time_step);
    TriangleMesh mesh;
    mesh.faces = discretization.mesh(level).faces;
    mesh.attributes = attributes_on(discretization.hierarchy(), level, model.mesh.attributes);
    animation.state = [mesh, states](std::size_t k) {
        TriangleMesh state = mesh;
        state.positions = *states.at(k).positions;
        return state;
    };
    return animation;
}

/// Packs files and folders of a folder.
void pack(const fs::path& folder, const std::vector<fs::path>& paths, const fs::path& archive) {
    std::vector<std::string> words{"tar", "--format=ustar", "-C", folder.string(), "-cf", archive.string()};
    for (const fs::path& path : paths)
        words.push_back(fs::relative(path, folder).string());
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    int status = 0;
    if (posix_spawnp(&child, "tar", nullptr, nullptr, arguments.data(), environ) != 0 ||
        waitpid(child, &status, 0) != child || status != 0)
        throw std::runtime_error(fmt::format("{} could not be packed by tar", archive.string()));
}

} // namespace

std::string export_states(const fs::path& folder, const std::string& name, AnimationFormat format,
                          const Discretization& discretization, const std::vector<Board::SavedFrame>& states) {
    const fs::path path = folder / main_name(name, format, states.size() == 1);
    const std::vector<fs::path> made = exported_files(format, path);
    write_animation(format, path, animation_of(name, discretization, states));
    if (made.size() == 1 && !fs::is_directory(path))
        return path.filename().string();
    const std::string archive = path.filename().string() + ".tar";
    pack(folder, made, folder / archive);
    return archive;
}

} // namespace plisse::studio
