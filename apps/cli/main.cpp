#include <algorithm>

#include <fmt/core.h>

#include <plisse/base/error.h>
#include <plisse/scene/json_cursor.h>

#ifdef PLISSE_HAS_STUDIO
#include <studio/studio_command.h>
#endif

#include "bench_command.h"
#include "check_command.h"
#include "exit_status.h"
#include "export_command.h"
#include "hierarchy_command.h"
#include "missing_studio_command.h"
#include "prolong_command.h"
#include "render_command.h"
#include "report_command.h"
#include "run_command.h"
#include "schema_command.h"

namespace {

using plisse::ExitCode;

/// Prints the one error line the contract promises.
ExitCode complain(const std::string& sentence, ExitCode code) {
    fmt::print(stderr, "plisse: error: {}\n", sentence);
    return code;
}

ExitCode complain_about_arguments(const CLI::App& app, const CLI::ParseError& error) {
    std::string help = "plisse";
    for (const CLI::App* command : app.get_subcommands())
        help += " " + command->get_name();
    return complain(fmt::format("command line: {}; `{} --help` lists what can be given", error.what(), help),
                    ExitCode::unusable);
}

void add_commands(CLI::App& app) {
    plisse::add_run_command(app);
    plisse::add_check_command(app);
    plisse::add_hierarchy_command(app);
    plisse::add_prolong_command(app);
    plisse::add_render_command(app);
    plisse::add_report_command(app);
    plisse::add_export_command(app);
    plisse::add_schema_command(app);
    plisse::add_bench_command(app);
#ifdef PLISSE_HAS_STUDIO
    plisse::add_studio_command(app);
#else
    plisse::add_missing_studio_command(app);
#endif
}

/// Throws for a first word that is neither an option nor a subcommand; the parser would only miss a subcommand.
void expect_subcommand(const CLI::App& app, int argc, char** argv) {
    if (argc < 2 || argv[1][0] == '-')
        return;
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({}))
        names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), argv[1]) != names.end())
        return;
    throw plisse::InputError("command line", fmt::format("there is no command \"{}\"", argv[1]),
                             fmt::format("the nearest is `plisse {}`", plisse::nearest_name(argv[1], names)));
}

ExitCode run_program(int argc, char** argv) {
    CLI::App app("plisse: progressive equilibria of thin shells and cloth in contact", "plisse");
    app.set_version_flag("--version", PLISSE_VERSION);
    app.require_subcommand(1);
    add_commands(app);
    expect_subcommand(app, argc, argv);
    try {
        app.parse(argc, argv);
        return ExitCode::done;
    } catch (const CLI::Success& help_or_version) {
        app.exit(help_or_version);
        return ExitCode::done;
    } catch (const CLI::ParseError& error) {
        return complain_about_arguments(app, error);
    }
}

} // namespace

int main(int argc, char** argv) {
    ExitCode code = ExitCode::done;
    try {
        code = run_program(argc, argv);
    } catch (const plisse::ExitStatus& status) {
        code = status.code;
    } catch (const plisse::InputError& error) {
        code = complain(error.what(), ExitCode::unusable);
    } catch (const std::exception& error) {
        code = complain(error.what(), ExitCode::failed);
    }
    return static_cast<int>(code);
}
