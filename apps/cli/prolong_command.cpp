#include "prolong_command.h"

#include <memory>

#include <fmt/core.h>

#include <plisse/base/error.h>
#include <plisse/mesh/read_mesh.h>
#include <plisse/mesh/write_ply.h>
#include <plisse/scene/hierarchy_folder.h>
#include <plisse/transfer/prolongation.h>

namespace plisse {

namespace {

struct ProlongArguments {
    std::string folder, positions, output, kind = "shell";
    int from = 0;
};

ProlongationOperator operator_named(const std::string& name) {
    if (name == "affine")
        throw InputError("--operator affine", "not supported in this version", "give shell, intrinsic or blend");
    if (name == "blend")
        return ProlongationOperator::blend;
    return name == "shell" ? ProlongationOperator::shell : ProlongationOperator::intrinsic;
}

void expect_level_mesh(const TriangleMesh& given, const TriangleMesh& level, const ProlongArguments& arguments) {
    if (given.vertex_count() != level.vertex_count() || given.faces != level.faces)
        throw InputError(arguments.positions,
                         fmt::format("it has {} vertices and {} faces that are not those of level {} ({} and {})",
                                     given.vertex_count(), given.face_count(), arguments.from, level.vertex_count(),
                                     level.face_count()),
                         fmt::format("give level-{}.ply of {} with other positions", arguments.from, arguments.folder));
}

void prolong(const ProlongArguments& arguments) {
    const ProlongationOperator kind = operator_named(arguments.kind);
    HierarchyFiles files = read_hierarchy(arguments.folder);
    const int finest = static_cast<int>(files.levels.size()) - 1;
    if (arguments.from > finest)
        throw InputError(fmt::format("--from {}", arguments.from), fmt::format("there are {} levels", finest + 1),
                         fmt::format("give a level from 0 to {}", finest));
    const auto from = static_cast<std::size_t>(arguments.from);
    const TriangleMesh given = read_mesh(arguments.positions).mesh;
    expect_level_mesh(given, files.levels[from], arguments);
    TriangleMesh& fine = files.levels.back();
    if (arguments.from < finest)
        fine.positions = Prolongation(files.levels[from].positions, files.levels[from].faces, files.to_finest[from],
                                      fine.positions, kind)
                             .apply(given.positions);
    else
        fine.positions = given.positions;
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
    command->add_option("--operator", arguments->kind, "shell, intrinsic or affine")
        ->check(CLI::IsMember({"shell", "intrinsic", "affine"}));
    command->callback([arguments] { prolong(*arguments); });
}

} // namespace plisse
