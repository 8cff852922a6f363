#include "export_states.h"

#include <stdexcept>

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <plisse/decimate/level_attributes.h>
#include <plisse/exports/formats.h>

extern char** environ;

namespace plisse::studio {

namespace {

namespace fs = std::filesystem;

AnimationFormat animation_format_of(ExportFormat format) {
    switch (format) {
    case ExportFormat::obj:
        return AnimationFormat::obj;
    case ExportFormat::ply:
        return AnimationFormat::ply;
    case ExportFormat::gltf:
        return AnimationFormat::gltf;
    case ExportFormat::usd:
        return AnimationFormat::usd;
    case ExportFormat::pvd:
        return AnimationFormat::pvd;
    case ExportFormat::pc2:
        return AnimationFormat::pc2;
    }
    throw std::logic_error("no such format");
}

/// What the format's main file or folder is called.
std::string main_name(const std::string& name, ExportFormat format, bool one_state) {
    switch (format) {
    case ExportFormat::obj:
        return name + (one_state ? ".obj" : "-obj");
    case ExportFormat::ply:
        return name + (one_state ? ".ply" : "-ply");
    case ExportFormat::gltf:
        return name + ".glb";
    case ExportFormat::usd:
        return name + ".usda";
    case ExportFormat::pvd:
        return name + ".pvd";
    case ExportFormat::pc2:
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

std::string export_states(const fs::path& folder, const std::string& name, ExportFormat format,
                          const Discretization& discretization, const std::vector<Board::SavedFrame>& states) {
    const AnimationFormat kind = animation_format_of(format);
    const fs::path path = folder / main_name(name, format, states.size() == 1);
    const std::vector<fs::path> made = exported_files(kind, path);
    write_animation(kind, path, animation_of(name, discretization, states));
    if (made.size() == 1 && !fs::is_directory(path))
        return path.filename().string();
    const std::string archive = path.filename().string() + ".tar";
    pack(folder, made, folder / archive);
    return archive;
}

} // namespace plisse::studio
