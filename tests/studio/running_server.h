#pragma once

#include <condition_variable>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <studio/server.h>

namespace plisse::studio {

/// Remembers what it is told and answers a few paths.
class FakeApplication : public Application {
public:
    void on_join(ClientId client) override;
    void on_leave(ClientId client) override;
    void on_message(ClientId client, std::string_view text) override;
    /// /api/echo and uploads: method, path, query and the body's length as lines. /api/file: `file`. /api/late: the
    /// reply is kept in `late`. /api/never: the reply is dropped. /api/throw: throws.
    void on_request(HttpRequest request, Reply reply) override;

    /// Waits until `holds` does, for 10 s at most, and returns whether it does. It may look at what is below.
    bool wait(const std::function<bool()>& holds);

    Server* server = nullptr; ///< when set, texts are sent back
    std::filesystem::path file;

    std::mutex mutex; ///< of the following
    std::condition_variable changed;
    std::set<ClientId> clients;
    std::size_t joins = 0, leaves = 0;
    std::vector<std::string> texts;
    std::vector<Reply> late;
};

/// A server on a thread of its own, stopped at the end.
class RunningServer {
public:
    explicit RunningServer(ServerOptions options = {});
    ~RunningServer() { stop(); }
    RunningServer(const RunningServer&) = delete;
    RunningServer& operator=(const RunningServer&) = delete;

    /// Stops it and waits for its thread.
    void stop();
    std::uint16_t port() const { return server.port(); }
    /// Whether it still answers both kinds of request.
    bool is_well();
    /// The client that has joined, when there is one.
    ClientId only_client();

    FakeApplication application;
    const std::string token = random_token();
    Server server;

private:
    std::thread thread_;
};

/// Waits until `holds` does, for 10 s at most, and returns whether it does.
bool eventually(const std::function<bool()>& holds);

} // namespace plisse::studio
