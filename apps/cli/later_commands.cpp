#include "later_commands.h"

#include <plisse/base/error.h>

namespace plisse {

namespace {

void add_later_command(CLI::App& app, const std::string& name, const std::string& description,
                       const std::string& instead) {
    CLI::App* command = app.add_subcommand(name, description + " (not in this version)");
    command->allow_extras();
    command->callback([name, instead] { throw InputError(name, "not supported in this version", instead); });
}

} // namespace

void add_later_commands(CLI::App& app) {
    add_later_command(app, "studio", "The interactive page on 127.0.0.1", "use `plisse run` and `plisse render`");
    add_later_command(app, "export", "Writes a run's animation for other programs",
                      "read the PLY files under DIR/frames, which most programs open");
}

} // namespace plisse
