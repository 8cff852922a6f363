#include "page_connection.h"

namespace plisse::studio {

void PageConnection::accept(const http::request<http::string_body>& request) {
    const ServerOptions& options = core_.options;
    // From here the WebSocket keeps the time.
    beast::get_lowest_layer(ws_).expires_never();
    ws_.set_option(websocket::stream_base::timeout{options.header_timeout, options.idle_timeout, true});
    ws_.read_message_max(options.message_bytes);
    ws_.auto_fragment(false);
    ws_.async_accept(request, [self = shared_from_this()](error_code error) {
        if (error || self->closing_)
            return self->end();
        self->core_.join(self);
        self->read();
    });
}

void PageConnection::read() {
    ws_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
        if (error)
            return self->end();
        if (!self->ws_.got_text())
            return self->close(websocket::close_code::unknown_data);
        self->on_message();
        self->buffer_.clear();
        if (!self->closing_)
            self->read();
    });
}

void PageConnection::on_message() {
    ++core_.messages;
    const auto data = buffer_.cdata();
    try {
        core_.application.on_message(id, {static_cast<const char*>(data.data()), data.size()});
    } catch (const std::exception&) {
        close(websocket::close_code::internal_error);
    }
}

void PageConnection::change_outbox(const std::function<bool(Outbox&)>& change) {
    const std::lock_guard lock(outbox_mutex_);
    if (overflowed_)
        return;
    if (!change(outbox_)) {
        overflowed_ = true;
        ++core_.overflows;
        outbox_.clear();
        asio::post(core_.context, [self = shared_from_this()] { self->cut_off(); });
    } else if (!flush_posted_) {
        flush_posted_ = true;
        asio::post(core_.context, [self = shared_from_this()] { self->flush(); });
    }
}

void PageConnection::flush() {
    std::optional<Outbox::Message> message;
    {
        const std::lock_guard lock(outbox_mutex_);
        flush_posted_ = false;
        if (writing_ || closing_ || ended_)
            return;
        message = outbox_.next();
    }
    if (!message)
        return;
    writing_ = true;
    ws_.text(message->kind == Outbox::Message::Kind::text);
    ws_.async_write(asio::buffer(message->bytes.data(), message->bytes.size()),
                    [self = shared_from_this(), owner = message->owner](error_code error, std::size_t) {
                        self->writing_ = false;
                        if (error)
                            self->cut_off();
                        else
                            self->flush();
                    });
}

void PageConnection::close(websocket::close_code code) {
    if (closing_ || ended_)
        return;
    closing_ = true;
    if (!ws_.is_open()) // still shaking hands
        return cut_off();
    // Reads what the page still sends until it says good-bye too, for header_timeout at most.
    ws_.async_close(code, [self = shared_from_this()](error_code) { self->end(); });
}

void PageConnection::end() {
    if (ended_)
        return;
    ended_ = true;
    cut_off();
    core_.leave(*this);
    core_.remove(shared_from_this());
    const std::lock_guard lock(outbox_mutex_);
    outbox_.clear();
}

} // namespace plisse::studio
