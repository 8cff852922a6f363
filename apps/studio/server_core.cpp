#include "server_core.h"

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "http_connection.h"
#include "page_connection.h"

namespace plisse::studio {

namespace {

/// How long run() waits for pages to answer its good-bye.
constexpr std::chrono::seconds good_bye{1};

} // namespace

ServerCore::ServerCore(ServerOptions given, Application& served) : options(std::move(given)), application(served) {
    const tcp::endpoint endpoint(asio::ip::address_v4::loopback(), options.port);
    try {
        acceptor_.open(endpoint.protocol());
        acceptor_.set_option(tcp::acceptor::reuse_address(true));
        acceptor_.bind(endpoint);
        acceptor_.listen();
        port = acceptor_.local_endpoint().port();
    } catch (const boost::system::system_error& error) {
        throw std::runtime_error("port " + std::to_string(options.port) +
                                 " of 127.0.0.1 cannot be had: " + error.code().message());
    }
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
    stop_.assign(ends[0]);
    stop_pipe_ = ends[1];
}

ServerCore::~ServerCore() {
    ::close(stop_pipe_);
}

void ServerCore::run() {
    stop_.async_read_some(asio::buffer(stop_byte_), [this](error_code, std::size_t) { go_away(); });
    accept();
    context.run();
    for (const std::shared_ptr<PageConnection>& client : clients())
        client->end();
}

void ServerCore::stop() const noexcept {
    // All that a signal handler may do. A full pipe holds the wish already.
    const int saved = errno;
    [[maybe_unused]] const ssize_t written = ::write(stop_pipe_, "", 1);
    errno = saved;
}

void ServerCore::go_away() {
    acceptor_.close();
    for (const auto& connection : std::set(connections_)) // a copy: they take themselves out
        connection->go_away();
    timer_.expires_after(good_bye);
    timer_.async_wait([this](error_code) { context.stop(); });
    if (connections_.empty())
        timer_.cancel();
}

void ServerCore::accept() {
    acceptor_.async_accept([this](error_code error, tcp::socket socket) {
        if (!acceptor_.is_open())
            return;
        if (error) { // such as too many open files: some will be closed
            timer_.expires_after(std::chrono::milliseconds{100});
            timer_.async_wait([this](error_code cancelled) {
                if (!cancelled)
                    accept();
            });
            return;
        }
        if (connections_.size() < options.connections) {
            error_code ignored;
            socket.set_option(tcp::no_delay(true), ignored);
            socket.set_option(asio::socket_base::send_buffer_size(options.send_buffer_bytes), ignored);
            const auto connection = std::make_shared<HttpConnection>(*this, std::move(socket));
            add(connection);
            connection->read_header(options.header_timeout);
        }
        accept();
    });
}

void ServerCore::add(const std::shared_ptr<Connection>& connection) {
    connections_.insert(connection);
    open_connections_ = connections_.size();
}

void ServerCore::remove(const std::shared_ptr<Connection>& connection) {
    connections_.erase(connection);
    open_connections_ = connections_.size();
    if (!acceptor_.is_open() && connections_.empty())
        timer_.cancel();
}

void ServerCore::join(const std::shared_ptr<PageConnection>& client) {
    client->id = ++last_id_;
    {
        const std::lock_guard lock(clients_mutex_);
        clients_.emplace(client->id, client);
    }
    try {
        application.on_join(client->id);
    } catch (const std::exception&) {
        client->go_away();
    }
}

void ServerCore::leave(const PageConnection& client) {
    {
        const std::lock_guard lock(clients_mutex_);
        if (clients_.erase(client.id) == 0)
            return; // never joined
        client.look_at_outbox([this](const Outbox& outbox) {
            gone_sent_ += outbox.sent_positions();
            gone_replaced_ += outbox.replaced_positions();
        });
    }
    application.on_leave(client.id);
}

std::shared_ptr<PageConnection> ServerCore::client(ClientId id) const {
    const std::lock_guard lock(clients_mutex_);
    const auto found = clients_.find(id);
    return found == clients_.end() ? nullptr : found->second;
}

std::vector<std::shared_ptr<PageConnection>> ServerCore::clients() const {
    const std::lock_guard lock(clients_mutex_);
    std::vector<std::shared_ptr<PageConnection>> all;
    for (const auto& [id, client] : clients_)
        all.push_back(client);
    return all;
}

ServerCounters ServerCore::counters() const {
    ServerCounters counters;
    const std::lock_guard lock(clients_mutex_);
    counters.connections = open_connections_;
    counters.clients = clients_.size();
    counters.refused = refused;
    counters.messages = messages;
    counters.overflows = overflows;
    counters.sent_positions = gone_sent_;
    counters.replaced_positions = gone_replaced_;
    for (const auto& [id, client] : clients_)
        client->look_at_outbox([&](const Outbox& outbox) {
            counters.queued_bytes += outbox.queued_bytes();
            counters.waiting_positions += outbox.has_positions() ? 1 : 0;
            counters.sent_positions += outbox.sent_positions();
            counters.replaced_positions += outbox.replaced_positions();
        });
    return counters;
}

} // namespace plisse::studio
