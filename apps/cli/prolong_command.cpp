#include "prolong_command.h"

#include <map>
#include <memory>
#include <string>

#include <fmt/core.h>

#include <plisse/base/error.h>
#include <plisse/decimate/level_prolongation.h>
#include <plisse/mesh/read_mesh.h>
#include <plisse/mesh/write_ply.h>
#include <plisse/scene/hierarchy_folder.h>

namespace plisse {

namespace {

struct ProlongArguments {
    std::string folder, positions, output, kind = "shell";
    int from = 0;
};

const std::map<std::string, ProlongationOperator> operators{{"shell", ProlongationOperator::shell},
                                                            {"intrinsic", ProlongationOperator::intrinsic},
                                                            {"blend", ProlongationOperator::blend},
                                                            {"affine", ProlongationOperator::affine}};

void expect_level_mesh(const TriangleMesh& given, const TriangleMesh& level, const ProlongArguments& arguments) {
    if (given.vertex_count() != level.vertex_count() || given.faces != level.faces)
        throw InputError(arguments.positions,
                         fmt::format("it has {} vertices and {} faces that are not those of level {} ({} and {})",
                                     given.vertex_count(), given.face_count(), arguments.from, level.vertex_count(),
                                     level.face_count()),
                         fmt::format("give level-{}.ply of {} with other positions", arguments.from, arguments.folder));
}

/// From a level below the finest of the folder's hierarchy to that.
Prolongation prolongation_of(const ProlongArguments& arguments, const HierarchyFiles& files) {
    const ProlongationOperator kind = operators.at(arguments.kind);
    const auto from = static_cast<std::size_t>(arguments.from);
    const TriangleMesh& fine = files.levels.back();
    if (kind != ProlongationOperator::affine)
        return {files.levels[from].positions, files.levels[from].faces, files.to_finest[from], fine.positions, kind};
    const Hierarchy hierarchy = read_collapses(arguments.folder);
    if (hierarchy.level_count() != static_cast<int>(files.levels.size()) || hierarchy.finest().faces != fine.faces)
        throw InputError(arguments.folder, "hierarchy.bin is not of the meshes beside it",
                         "write the folder again with `plisse hierarchy`");
    if (hierarchy.collapses.empty())
        throw InputError(arguments.folder, "its levels were made by subdivision, and affine needs collapses",
                         "take shell, blend or intrinsic");
    return prolongation_to_finest(hierarchy, arguments.from, kind);
}

void prolong(const ProlongArguments& arguments) {
    HierarchyFiles files = read_hierarchy(arguments.folder);
    const int finest = static_cast<int>(files.levels.size()) - 1;
    if (arguments.from > finest)
        throw InputError(fmt::format("--from {}", arguments.from), fmt::format("there are {} levels", finest + 1),
                         fmt::format("give a level from 0 to {}", finest));
    const TriangleMesh given = read_mesh(arguments.positions).mesh;
    expect_level_mesh(given, files.levels[static_cast<std::size_t>(arguments.from)], arguments);
    TriangleMesh& fine = files.levels.back();
    fine.positions =
        arguments.from < finest ? prolongation_of(arguments, files).apply(given.positions) : given.positions;
    write_ply(arguments.output, fine);
}

} // namespace

void add_prolong_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("prolong", "Carries deformed coarse positions to the finest mesh");
    auto arguments = std::make_shared<ProlongArguments>();
    command->add_option("HIERARCHY-DIR", arguments->folder, "folder that `plisse hierarchy` wrote")->required();
    command->add_option("--from", arguments->from, "level of the given positions")
        ->required()
        ->check(CLI::NonNegativeNumber);
    command->add_option("--positions", arguments->positions, "deformed mesh of that level")->required();
    command->add_option("-o,--output", arguments->output, "PLY file for the finest mesh")->required();
    command->add_option("--operator", arguments->kind, "shell, intrinsic, blend or affine")
        ->check(CLI::IsMember(operators));
    command->callback([arguments] { prolong(*arguments); });
}

} // namespace plisse
