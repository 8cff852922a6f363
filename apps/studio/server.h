#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "page_assets.h"

namespace plisse::studio {

/// A page's WebSocket connection; never used twice.
using ClientId = std::uint64_t;
using Bytes = std::vector<unsigned char>;

/// A request below /api/ that has shown the token.
struct HttpRequest {
    std::string method; ///< GET or POST
    std::string path;   ///< decoded; begins with /api/, and no segment is ".", ".." or, but for the last, empty
    std::map<std::string, std::string> query; ///< decoded; of a name that comes twice, the last
    std::string body;
};

/// The body is that of `file` where it is not empty, else `body`.
struct HttpAnswer {
    int status = 200;
    std::string content_type = "application/json";
    std::string body;
    /// Streamed; 404 when it cannot be opened, is a link or no ordinary file.
    std::filesystem::path file;
    std::string download_name; ///< not empty: the page saves the body under this name
};

/// {"ok": false, "message": ...} with this status.
HttpAnswer refusal(int status, const std::string& message);

/// Answers one request, at once or later, from any thread; only the first call counts. When all copies have gone
/// without a call, the answer is 500.
using Reply = std::function<void(HttpAnswer)>;

/// What is served. Every function is called on the thread of Server::run, must return quickly, and may call the
/// server's sending functions.
class Application {
public:
    virtual ~Application() = default;

    /// A page has joined; what is sent to it here comes before whatever is sent later.
    virtual void on_join(ClientId client) = 0;
    /// It has gone, for whatever reason; once for every on_join, before run() returns.
    virtual void on_leave(ClientId client) = 0;
    /// A text message, valid UTF-8 of at most ServerOptions::message_bytes.
    virtual void on_message(ClientId client, std::string_view text) = 0;
    /// A request below /api/ other than the WebSocket's.
    virtual void on_request(HttpRequest request, Reply reply) = 0;
};

struct ServerOptions {
    std::uint16_t port = 0;        ///< 0: any that is free
    std::string token;             ///< empty: random_token()
    std::span<const Asset> assets; ///< page_assets()

    /// Where a POST is taken, and the largest body, in bytes. Bodies are held in memory, two uploads at a time.
    std::map<std::string, std::size_t> uploads = {{"/api/mesh", std::size_t{256} << 20},
                                                  {"/api/scene", std::size_t{4} << 20}};
    std::size_t connections = 64;        ///< at a time; more are closed at once
    std::size_t header_bytes = 16 << 10; ///< of a request
    std::size_t message_bytes = 1 << 20; ///< of a WebSocket message; a longer one closes its connection

    /// A page whose unsent messages exceed any of these is disconnected. (One mesh alone may exceed mesh_queue_bytes.)
    std::size_t text_queue_messages = 1024;
    std::size_t text_queue_bytes = std::size_t{16} << 20;
    std::size_t mesh_queue_bytes = std::size_t{256} << 20;
    /// Kernel buffer of a connection: positions in it are out of reach of newer ones.
    int send_buffer_bytes = 256 << 10;

    std::chrono::milliseconds header_timeout{10'000}; ///< for a request's header; an upgrade's handshake
    std::chrono::milliseconds stall_timeout{30'000};  ///< without a byte of a body coming or going
    std::chrono::milliseconds idle_timeout{60'000};   ///< of a kept connection; of a page that answers no ping
};

/// What a server has done so far, for tests and reports.
struct ServerCounters {
    std::size_t connections = 0;       ///< open now, HTTP and WebSocket
    std::size_t clients = 0;           ///< joined now
    std::size_t queued_bytes = 0;      ///< of text and meshes not sent now, over all clients
    std::size_t waiting_positions = 0; ///< not sent now: at most one a client
    std::uint64_t refused = 0;         ///< requests answered 403
    std::uint64_t messages = 0;        ///< texts given to the application
    std::uint64_t sent_positions = 0;
    std::uint64_t replaced_positions = 0; ///< by newer ones or by a new mesh, before they were sent
    std::uint64_t overflows = 0;          ///< clients disconnected because their queue was full
};

/// 128 bits from the system's random source, as 32 hexadecimal digits.
std::string random_token();

class ServerCore;

/// Serves the page and one application to browsers on this machine: binds 127.0.0.1 only, and answers 403 to whoever
/// does not know the token, calls this machine by another name (DNS rebinding), or comes from another page (Origin).
/// Reads no file but those the application names.
///
/// What a client is sent: texts and meshes in the order they were given. Positions have one place, where the newest
/// replaces the one before, and never pass a mesh given before them: send_mesh empties the place (what stood there
/// belongs to the mesh before) and the place is not looked at while a mesh waits. So a page never gets positions before
/// the mesh they belong to, if they were offered after it. Between texts and positions there is no order.
class Server {
public:
    /// Listens at once, so that port() and url() are known; connections wait until run(). The application must outlive
    /// the server. Throws std::runtime_error when the port cannot be had.
    Server(ServerOptions options, Application& application);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Serves until stop(), then tells the pages that it goes away and returns within about a second. Once.
    void run();
    /// Safe from any thread and from a signal handler; before run() too.
    void stop() noexcept;

    std::uint16_t port() const;
    /// http://127.0.0.1:PORT/?token=TOKEN
    std::string url() const;
    ServerCounters counters() const;

    /// These are safe from any thread, never wait, and do nothing for a client that has gone.
    void send_text(ClientId client, std::string json);
    void send_text_to_all(std::string json);
    void send_mesh(ClientId client, std::shared_ptr<const Bytes> message);
    void offer_positions(ClientId client, std::shared_ptr<const Bytes> message);

private:
    std::shared_ptr<ServerCore> core_;
};

} // namespace plisse::studio
