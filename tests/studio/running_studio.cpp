#include "running_studio.h"

namespace plisse::studio {

const char* const small_scene_text = R"({
    "plisse": 1, "name": "small",
    "bodies": [{"name": "cloth", "mesh": {"generate": "sheet", "size": [0.5, 0.5], "edge_length": 0.03},
                "transform": {"translate": [0, 0.12, 0]}, "material": "cotton"}],
    "obstacles": [{"name": "ball", "mesh": {"generate": "sphere", "radius": 0.1, "edge_length": 0.03}}],
    "handles": [{"name": "corner", "body": "cloth", "select": {"box": [[-0.3, 0, -0.3], [-0.2, 1, -0.2]]}}],
    "contact": {"distance": 3e-3, "friction": 0.3},
    "hierarchy": {"levels": 2, "coarsest_vertices": 80},
    "solve": {"time_step": 0.05, "duration": 0.3, "frame_interval": 0.05}
})";

namespace {

ServerOptions with_token(ServerOptions options, const std::string& token) {
    options.token = token;
    return options;
}

} // namespace

RunningStudio::RunningStudio(const char* scene, const std::filesystem::path* session_folder, ServerOptions options)
    : folder(session_folder ? *session_folder : own_folder_.path() / "session"), studio(folder),
      server(with_token(std::move(options), token), studio) {
    studio.start(server);
    if (scene) {
        write_text(own_folder_.path() / "scene.json", scene);
        studio.open(own_folder_.path() / "scene.json");
    }
    thread_ = std::thread([this] { server.run(); });
}

void RunningStudio::stop() {
    server.stop();
    if (thread_.joinable())
        thread_.join();
    studio.stop();
}

bool RunningStudio::is_well() {
    return get("/api/gallery").status == 200 && WatchingPage(*this).is_open();
}

RawResponse RunningStudio::get(const std::string& target) {
    return ask(port(), request("GET", target, port(), token));
}

RawResponse RunningStudio::post(const std::string& target, const std::string& body) {
    return ask(port(), request("POST", target, port(), token, "", body));
}

WatchingPage::WatchingPage(const RunningStudio& running) : page(running.port(), running.token) {}

void WatchingPage::keep(const std::string& bytes) {
    constexpr char kind_positions = 2;
    if (bytes.at(0) == kind_positions)
        states.push_back(bytes);
}

} // namespace plisse::studio
