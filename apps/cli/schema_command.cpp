#include "schema_command.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <plisse/scene/scene_schema.h>

namespace plisse {

void add_schema_command(CLI::App& app) {
    app.add_subcommand("schema", "Prints the JSON Schema of scene files")->callback([] {
        fmt::print("{}\n", scene_schema().dump(2));
    });
}

} // namespace plisse
