#include "render_command.h"

#include <array>
#include <charconv>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/core.h>

#include <plisse/base/error.h>
#include <plisse/picture/write_png.h>

#include "render_picture.h"

namespace plisse {

namespace {

struct RenderArguments {
    std::string source, output, camera, size, color = "body";
    int frame = -1, level = -1;
    bool edges = false, sheet = false;
};

constexpr int largest_side = 16384; ///< pixels

std::optional<std::pair<int, int>> parse_size(const std::string& text) {
    std::pair<int, int> size;
    const char* const end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, size.first);
    if (width.ec != std::errc{} || width.ptr == end || *width.ptr != 'x')
        return std::nullopt;
    const auto height = std::from_chars(width.ptr + 1, end, size.second);
    const auto fits = [](int side) { return side >= 16 && side <= largest_side; };
    if (height.ec != std::errc{} || height.ptr != end || !fits(size.first) || !fits(size.second))
        return std::nullopt;
    return size;
}

Coloring parse_coloring(const std::string& text) {
    constexpr std::array<std::pair<const char*, Coloring>, 5> names = {{{"stretch", Coloring::stretch},
                                                                        {"curvature", Coloring::curvature},
                                                                        {"coarseness", Coloring::coarseness},
                                                                        {"body", Coloring::body},
                                                                        {"none", Coloring::none}}};
    for (const auto& [name, coloring] : names)
        if (text == name)
            return coloring;
    throw InputError("--color", fmt::format("'{}' is not a colouring", text),
                     "give stretch, curvature, coarseness, body or none");
}

DrawOptions draw_options(const RenderArguments& arguments) {
    DrawOptions options;
    options.edges = arguments.edges;
    if (arguments.sheet)
        options.width = 640, options.height = 480;
    if (!arguments.camera.empty()) {
        const auto view = parse_view(arguments.camera);
        if (!view)
            throw InputError("--camera", fmt::format("'{}' is not a view", arguments.camera),
                             "give AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,ZOOM in degrees, such as 35,18 or 35,18,1.5");
        options.view = *view;
    }
    if (!arguments.size.empty()) {
        const auto size = parse_size(arguments.size);
        if (!size)
            throw InputError("--size", fmt::format("'{}' is not a size", arguments.size),
                             fmt::format("give WIDTHxHEIGHT in pixels from 16 to {}, such as 960x640", largest_side));
        std::tie(options.width, options.height) = *size;
    }
    return options;
}

/// Better said before the picture is drawn than after.
void expect_folder_of(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder))
        throw InputError(file.string(), "its folder does not exist", "make the folder, or give another place");
}

SavedFrame chosen_frame(const SavedRun& run, int level, int number) {
    if (level < 0 && number < 0 && run.final_state)
        return *run.final_state;
    const SavedFrame* const frame = run.last_frame(level < 0 && number >= 0 ? run.finest_level() : level, number, "");
    if (!frame)
        throw InputError(run.folder.string(), "it has no such frame",
                         fmt::format("{} lists those it has", (run.folder / "frames" / "index.jsonl").string()));
    return *frame;
}

Image draw_portrait(const Portrait& portrait, Coloring coloring, DrawOptions options) {
    options.scalars = portrait.scalars ? &*portrait.scalars : nullptr;
    options.tell_bodies_apart = coloring != Coloring::none;
    return draw(portrait.subject(), options);
}

void render(const RenderArguments& arguments) {
    const Coloring coloring = parse_coloring(arguments.color);
    const DrawOptions options = draw_options(arguments);
    expect_folder_of(arguments.output);
    if (!std::filesystem::is_directory(arguments.source)) {
        if (arguments.sheet || arguments.frame >= 0 || arguments.level >= 0)
            throw InputError(arguments.source, "--sheet, --frame and --level need a run",
                             "give the output folder of a run");
        write_png(arguments.output, draw_portrait(portrait_of_mesh(arguments.source, coloring), coloring, options));
        return;
    }
    const SavedRun run = open_run(arguments.source);
    if (arguments.sheet)
        write_png(arguments.output, draw_sheet(run, coloring, options));
    else {
        const SavedFrame frame = chosen_frame(run, arguments.level, arguments.frame);
        write_png(arguments.output, draw_portrait(portrait_of_frame(run, frame, coloring), coloring, options));
    }
}

} // namespace

void add_render_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("render", "Draws a run or a mesh as a PNG, without any display");
    const auto arguments = std::make_shared<RenderArguments>();
    command->add_option("source", arguments->source, "The output folder of a run, or a mesh file")->required();
    command->add_option("-o,--output", arguments->output, "The picture to write (PNG)")->required();
    command->add_option("--frame", arguments->frame, "Frame number (the last)")->check(CLI::NonNegativeNumber);
    command->add_option("--level", arguments->level, "Level (the finest)")->check(CLI::NonNegativeNumber);
    command->add_option("--camera", arguments->camera,
                        "AZIMUTH,ELEVATION[,ZOOM] in degrees; 0,0 looks from +z, 90,0 from +x (35,18)");
    command->add_option("--size", arguments->size,
                        "WIDTHxHEIGHT in pixels, of each picture (960x640; 640x480 on a sheet)");
    command->add_option("--color", arguments->color,
                        "stretch, curvature, coarseness (above 1: the mesh is too coarse there), body or none (body)");
    command->add_flag("--edges", arguments->edges, "Draw the mesh's edges");
    command->add_flag("--sheet", arguments->sheet, "The preview, each level and the final state on one sheet");
    command->callback([arguments] { render(*arguments); });
}

} // namespace plisse
