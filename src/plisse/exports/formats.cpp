#include <plisse/exports/formats.h>

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <plisse/base/error.h>
#include <plisse/exports/unfinished_files.h>
#include <plisse/exports/write_gltf.h>
#include <plisse/exports/write_obj.h>
#include <plisse/exports/write_pc2.h>
#include <plisse/exports/write_pvd.h>
#include <plisse/exports/write_sequence.h>
#include <plisse/exports/write_usd.h>
#include <plisse/mesh/write_ply.h>

namespace plisse {

namespace fs = std::filesystem;

namespace {

struct FormatTraits {
    AnimationFormat format;
    const char* name;
    std::vector<std::string> extensions; ///< of its files
    bool may_be_folder;
};

const std::vector<FormatTraits>& all_formats() {
    static const std::vector<FormatTraits> formats = {{AnimationFormat::usd, "usd", {".usda", ".usd"}, false},
                                                      {AnimationFormat::gltf, "gltf", {".glb", ".gltf"}, false},
                                                      {AnimationFormat::pvd, "pvd", {".pvd"}, false},
                                                      {AnimationFormat::pc2, "pc2", {".pc2"}, false},
                                                      {AnimationFormat::obj, "obj", {".obj"}, true},
                                                      {AnimationFormat::ply, "ply", {".ply"}, true}};
    return formats;
}

const FormatTraits& traits_of(AnimationFormat format) {
    return all_formats()[static_cast<std::size_t>(format)];
}

std::string lower_extension(const fs::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

bool has_extension(const FormatTraits& format, const fs::path& path) {
    return std::find(format.extensions.begin(), format.extensions.end(), lower_extension(path)) !=
           format.extensions.end();
}

/// A folder may have any name but one that says it is a file of another format.
bool is_folder_name(const FormatTraits& format, const fs::path& path) {
    return format.may_be_folder && std::none_of(all_formats().begin(), all_formats().end(),
                                                [&](const FormatTraits& other) { return has_extension(other, path); });
}

/// "folder/" is "folder".
fs::path without_slash(const fs::path& path) {
    return path.has_filename() ? path : path.parent_path();
}

void write_single(AnimationFormat format, const fs::path& path, const Animation& animation) {
    if (animation.size() != 1)
        throw InputError(
            path.string(), fmt::format("a file holds one state, and these are {}", animation.size()),
            fmt::format("give the name of a folder, such as {}", fs::path(path).replace_extension().string()));
    UnfinishedFiles unfinished;
    const fs::path place = unfinished.add_file(path);
    if (format == AnimationFormat::obj)
        write_obj(place, animation.state(0), animation.face_part, animation.parts);
    else
        write_ply(place, animation.state(0), animation.face_part);
    unfinished.finish();
}

} // namespace

std::optional<AnimationFormat> animation_format(const std::string& name) {
    for (const FormatTraits& format : all_formats())
        if (format.name == name)
            return format.format;
    return std::nullopt;
}

std::vector<fs::path> exported_files(AnimationFormat format, const fs::path& path) {
    const FormatTraits& traits = traits_of(format);
    if (is_folder_name(traits, path))
        return {without_slash(path)};
    if (!has_extension(traits, path))
        throw InputError(path.string(), fmt::format("this is no name for the format {}", traits.name),
                         fmt::format("give a name that ends in {}{}", fmt::join(traits.extensions, " or "),
                                     traits.may_be_folder ? ", or that of a folder" : ""));
    if (format == AnimationFormat::gltf && lower_extension(path) == ".gltf")
        return {path, gltf_buffer_file(path)};
    if (format == AnimationFormat::pvd)
        return {path, pvd_folder(path)};
    if (format == AnimationFormat::pc2)
        return {path, pc2_mesh_file(path)};
    return {path};
}

void write_animation(AnimationFormat format, const fs::path& path, const Animation& animation) {
    const fs::path place = exported_files(format, path).front();
    switch (format) {
    case AnimationFormat::usd:
        return write_usd(place, animation);
    case AnimationFormat::gltf:
        return write_gltf(place, animation);
    case AnimationFormat::pvd:
        return write_pvd(place, animation);
    case AnimationFormat::pc2:
        return write_pc2(place, animation);
    case AnimationFormat::obj:
    case AnimationFormat::ply:
        if (has_extension(traits_of(format), place))
            return write_single(format, place, animation);
        return format == AnimationFormat::obj ? write_obj_sequence(place, animation)
                                              : write_ply_sequence(place, animation);
    }
}

} // namespace plisse
