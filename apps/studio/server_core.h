#pragma once

#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility> // Boost.Asio 1.74 uses std::exchange without it
#include <vector>

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "server.h"

namespace plisse::studio {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

/// A socket and what is done with it.
class Connection {
public:
    virtual ~Connection() = default;
    /// The server ends.
    virtual void go_away() = 0;
};

class PageConnection;

/// What a server's connections share. Everything in it, and in them, runs on the thread of run() but for what is said
/// to be safe from any.
class ServerCore : public std::enable_shared_from_this<ServerCore> {
public:
    ServerCore(ServerOptions options, Application& application);
    ~ServerCore();

    void run();
    void stop() const noexcept;

    /// The connections that are open.
    void add(const std::shared_ptr<Connection>& connection);
    void remove(const std::shared_ptr<Connection>& connection);

    void join(const std::shared_ptr<PageConnection>& client);
    void leave(const PageConnection& client);
    std::shared_ptr<PageConnection> client(ClientId id) const;
    std::vector<std::shared_ptr<PageConnection>> clients() const;
    ServerCounters counters() const;

    const ServerOptions options;
    Application& application;
    std::uint16_t port = 0;
    int uploads = 0; ///< being read, or waiting for their answer
    std::atomic<std::uint64_t> refused{0}, messages{0}, overflows{0};

private:
    void accept();
    void go_away();

    std::atomic<std::size_t> open_connections_{0};
    std::uint64_t gone_sent_ = 0, gone_replaced_ = 0; ///< positions of clients that have left
    int stop_pipe_ = -1;                              ///< its writing end
    std::array<char, 1> stop_byte_{};
    ClientId last_id_ = 0;

public:
    /// After all that its handlers may still touch when it is destroyed.
    asio::io_context context{1};

private:
    tcp::acceptor acceptor_{context};
    asio::posix::stream_descriptor stop_{context};
    asio::steady_timer timer_{context};
    std::set<std::shared_ptr<Connection>> connections_;
    mutable std::mutex clients_mutex_; ///< of the next and of gone_...
    std::map<ClientId, std::shared_ptr<PageConnection>> clients_;
};

} // namespace plisse::studio
