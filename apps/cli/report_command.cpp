#include "report_command.h"

#include <memory>

#include <fmt/core.h>

#include <plisse/scene/whole_file.h>

#include "report_page.h"
#include "report_table.h"

namespace plisse {

namespace {

struct ReportArguments {
    std::string folder, compare, html;
};

void report_run(const ReportArguments& arguments) {
    const StoredReport stored = read_report(arguments.folder);
    if (!arguments.html.empty())
        write_file_atomically(arguments.html, report_page(stored, read_log(arguments.folder)));
    if (arguments.compare.empty())
        fmt::print("{}", report_table(stored));
    else
        fmt::print("{}", comparison_table(stored, arguments.folder, read_report(arguments.compare), arguments.compare));
}

} // namespace

void add_report_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("report", "Prints a run's time per level and phase, iterations and gaps");
    auto arguments = std::make_shared<ReportArguments>();
    command->add_option("DIR", arguments->folder, "output folder of a run")->required();
    command->add_option("--compare", arguments->compare, "output folder of another run, shown beside it");
    command->add_option("--html", arguments->html, "writes a page to this file too");
    command->callback([arguments] { report_run(*arguments); });
}

} // namespace plisse
