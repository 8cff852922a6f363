#pragma once

#include <functional>

#include "outbox.h"
#include "server_core.h"

namespace plisse::studio {

/// A page's WebSocket.
class PageConnection final : public Connection, public std::enable_shared_from_this<PageConnection> {
public:
    PageConnection(ServerCore& core, beast::tcp_stream&& stream)
        : core_(core), ws_(std::move(stream)),
          outbox_({core.options.text_queue_messages, core.options.text_queue_bytes, core.options.mesh_queue_bytes}) {}

    void accept(const http::request<http::string_body>& request);
    void go_away() override { close(websocket::close_code::going_away); }
    void cut_off() { beast::get_lowest_layer(ws_).close(); }
    void end();

    /// Changes what is to be sent, then sees to it that it is sent. `change` returns false when a limit is exceeded.
    /// Safe from any thread.
    void change_outbox(const std::function<bool(Outbox&)>& change);
    /// Safe from any thread.
    template <typename Look>
    void look_at_outbox(const Look& look) const {
        const std::lock_guard lock(outbox_mutex_);
        look(outbox_);
    }

    ClientId id = 0;

private:
    void read();
    void on_message();
    void flush();
    void close(websocket::close_code code);

    ServerCore& core_;
    websocket::stream<beast::tcp_stream> ws_;
    beast::flat_buffer buffer_;
    bool ended_ = false, closing_ = false, writing_ = false;

    mutable std::mutex outbox_mutex_; ///< of the following
    Outbox outbox_;
    bool overflowed_ = false, flush_posted_ = false;
};

} // namespace plisse::studio
