#include "running_server.h"

#include <algorithm>
#include <stdexcept>

#include "raw_client.h"

namespace plisse::studio {

namespace {

constexpr unsigned char page[] = "<!doctype html>";
constexpr unsigned char script[] = "let a = 1;";
constexpr Asset assets[] = {{"index.html", "text/html", std::span(page).first(sizeof page - 1)},
                            {"assets/a.js", "text/javascript", std::span(script).first(sizeof script - 1)}};

ServerOptions with_assets(ServerOptions options, const std::string& token) {
    options.token = token;
    options.assets = assets;
    return options;
}

} // namespace

void FakeApplication::on_join(ClientId client) {
    const std::lock_guard lock(mutex);
    clients.insert(client);
    ++joins;
    changed.notify_all();
}

void FakeApplication::on_leave(ClientId client) {
    const std::lock_guard lock(mutex);
    clients.erase(client);
    ++leaves;
    changed.notify_all();
}

void FakeApplication::on_message(ClientId client, std::string_view text) {
    if (text == "throw")
        throw std::runtime_error("as asked");
    if (server)
        server->send_text(client, std::string(text));
    const std::lock_guard lock(mutex);
    texts.emplace_back(text);
    changed.notify_all();
}

void FakeApplication::on_request(HttpRequest request, Reply reply) {
    HttpAnswer answer;
    if (request.path == "/api/file") {
        answer.content_type = "application/octet-stream";
        answer.file = file;
        answer.download_name = "cloth\r\n\".obj";
    } else if (request.path == "/api/late") {
        const std::lock_guard lock(mutex);
        late.push_back(std::move(reply));
        changed.notify_all();
        return;
    } else if (request.path == "/api/never") {
        return;
    } else if (request.path == "/api/throw") {
        throw std::runtime_error("as asked");
    } else {
        answer.body = request.method + " " + request.path + "\n";
        for (const auto& [name, value] : request.query)
            answer.body += name + "=" + value + "\n";
        answer.body += std::to_string(request.body.size());
    }
    reply(std::move(answer));
}

bool FakeApplication::wait(const std::function<bool()>& holds) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, std::chrono::seconds(10), holds);
}

RunningServer::RunningServer(ServerOptions options)
    : server(with_assets(std::move(options), token), application), thread_([this] { server.run(); }) {}

void RunningServer::stop() {
    server.stop();
    if (thread_.joinable())
        thread_.join();
}

bool RunningServer::is_well() {
    const bool answers = ask(port(), request("GET", "/api/echo", port(), token)).body == "GET /api/echo\n0";
    return answers && RawPage(port(), token).is_open();
}

ClientId RunningServer::only_client() {
    application.wait([&] { return application.clients.size() == 1; });
    const std::lock_guard lock(application.mutex);
    return application.clients.empty() ? 0 : *application.clients.begin();
}

bool eventually(const std::function<bool()>& holds) {
    for (int tries = 0; tries < 2000 && !holds(); ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return holds();
}

} // namespace plisse::studio
