#include "export_command.h"

#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include <plisse/base/error.h>
#include <plisse/exports/formats.h>

#include "exit_status.h"
#include "interrupt.h"
#include "saved_animation.h"

namespace plisse {

namespace {

struct ExportArguments {
    std::string source, format, output;
    AnimationChoice choice;
    bool overwrite = false;
};

AnimationFormat parse_format(const std::string& text) {
    const auto format = animation_format(text);
    if (!format)
        throw InputError("--format", fmt::format("'{}' is not a format", text), "give usd, gltf, pvd, pc2, obj or ply");
    return *format;
}

void expect_free_places(AnimationFormat format, const std::string& output, bool overwrite) {
    for (const std::filesystem::path& place : exported_files(format, output)) {
        const std::filesystem::path folder = place.parent_path();
        if (!folder.empty() && !std::filesystem::is_directory(folder))
            throw InputError(place.string(), "its folder does not exist", "make the folder, or give another place");
        if (!overwrite && std::filesystem::exists(place))
            throw InputError(place.string(), "it exists already", "give another name, or --overwrite");
    }
}

/// Ctrl-C between two states ends the export, and the writer leaves nothing behind.
void make_interruptible(Animation& animation, const Context& context) {
    animation.state = [state = std::move(animation.state), &context](std::size_t k) {
        if (context.cancelled()) {
            fmt::print(stderr, "plisse: interrupted; nothing was written\n");
            throw ExitStatus{ExitCode::interrupted};
        }
        return state(k);
    };
}

void export_run(const ExportArguments& arguments) {
    const AnimationFormat format = parse_format(arguments.format);
    expect_free_places(format, arguments.output, arguments.overwrite);
    SavedAnimation saved = open_animation(open_run(arguments.source), arguments.choice);
    Context context;
    const InterruptGuard guard(context);
    make_interruptible(saved.animation, context);
    write_animation(format, arguments.output, saved.animation);

    const Animation& animation = saved.animation;
    if (animation.size() == 1)
        fmt::print("{}: one state of level {}\n", arguments.output, saved.level);
    else
        fmt::print("{}: {} states of level {}, from {:.4g} to {:.4g} s\n", arguments.output, animation.size(),
                   saved.level, animation.times.front(), animation.times.back());
}

} // namespace

void add_export_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("export", "Writes a run's animation for other programs");
    const auto arguments = std::make_shared<ExportArguments>();
    command->add_option("source", arguments->source, "The output folder of a run")->required();
    command
        ->add_option(
            "--format", arguments->format,
            "usd (.usda: time-sampled points), gltf (.glb, or .gltf and .bin: morph targets), pvd (and a folder "
            "of .vtp: ParaView), pc2 (and the .obj to put it on), obj or ply (a folder of numbered files)")
        ->required();
    command
        ->add_option("-o,--output", arguments->output,
                     "The file to write; for obj and ply a folder, or with --final a file")
        ->required();
    CLI::Option* level =
        command
            ->add_option("--level", arguments->choice.level,
                         "The level whose frames are exported (that with the most: the one the timeline ran on)")
            ->check(CLI::NonNegativeNumber);
    command->add_flag("--final", arguments->choice.final_only, "Only the last state, on the finest level (final.ply)")
        ->excludes(level);
    command->add_option("--every", arguments->choice.every, "Keep every so many frames, and the last (1)")
        ->check(CLI::PositiveNumber);
    command
        ->add_option("--fps", arguments->choice.fps,
                     "Show so many frames a second, evenly (at the timeline's own times; states that were saved "
                     "while it stood still follow at the usual interval)")
        ->check(CLI::PositiveNumber);
    command->add_flag("--overwrite", arguments->overwrite, "Replace what exists");
    command->callback([arguments] { export_run(*arguments); });
}

} // namespace plisse
