#include "studio_command.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include <plisse/base/parallel.h>

#include "page_assets.h"
#include "server.h"
#include "studio.h"

namespace plisse {

namespace {

namespace fs = std::filesystem;

struct StudioArguments {
    std::string scene, folder = "plisse-studio";
    int port = 0, threads = 0;
    bool no_open = false;
};

// A signal handler can reach nothing but a global.
studio::Server* serving = nullptr;

void stop_serving(int) {
    serving->stop();
}

/// Asks the desktop for a browser; where there is none, the address that was printed has to do.
void open_browser(const std::string& url) {
    if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr)
        return;
    const std::string command = "xdg-open '" + url + "' > /dev/null 2>&1 &";
    if (std::system(command.c_str()) != 0)
        fmt::print(stderr, "plisse: no browser could be opened\n");
}

void serve(const StudioArguments& arguments) {
    const ThreadLimit limit(arguments.threads);
    studio::Studio application(arguments.folder);
    studio::ServerOptions options;
    options.port = static_cast<std::uint16_t>(arguments.port);
    options.assets = studio::page_assets();
    studio::Server server(options, application);
    application.start(server);
    if (!arguments.scene.empty())
        application.open(arguments.scene);
    serving = &server;
    std::signal(SIGINT, stop_serving);
    std::signal(SIGTERM, stop_serving);
    fmt::print("plisse studio: {}\nCtrl-C ends it; what is saved goes to {}\n", server.url(), arguments.folder);
    if (const fs::path last = fs::path(arguments.folder) / (std::string(studio::Autosave::name) + ".json");
        arguments.scene.empty() && fs::exists(last))
        fmt::print("to go on where the last session ended: plisse studio {}\n", last.string());
    std::fflush(stdout);
    if (!arguments.no_open)
        open_browser(server.url());
    server.run();
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    application.stop();
}

} // namespace

void add_studio_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("studio", "Opens a page on this machine to steer a run by hand");
    auto arguments = std::make_shared<StudioArguments>();
    command->add_option("SCENE", arguments->scene, "scene file (JSON); left out: choose on the page");
    command->add_option("-o,--output", arguments->folder, "folder for what is saved; made when needed")
        ->capture_default_str();
    command->add_option("--port", arguments->port, "of the page; 0: any that is free")->check(CLI::Range(0, 65535));
    command->add_option("--threads", arguments->threads, "threads; 0: one a processor")->check(CLI::Range(0, 1024));
    command->add_flag("--no-open", arguments->no_open, "opens no browser");
    command->callback([arguments] { serve(*arguments); });
}

} // namespace plisse
