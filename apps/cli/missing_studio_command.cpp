#include "missing_studio_command.h"

#include <plisse/base/error.h>

namespace plisse {

void add_missing_studio_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("studio", "The interactive page on 127.0.0.1 (not in this build)");
    command->allow_extras();
    command->callback([] {
        throw InputError("studio", "this plisse was built without it",
                         "build with PLISSE_BUILD_STUDIO=ON, or use `plisse run` and `plisse render`");
    });
}

} // namespace plisse
