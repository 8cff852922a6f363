#pragma once

#include <optional>

#include "http_text.h"
#include "server_core.h"

namespace plisse::studio {

/// A response on its way.
template <typename Body>
struct Writing {
    explicit Writing(http::response<Body>&& given) : response(std::move(given)) {}
    http::response<Body> response;
    http::serializer<false, Body> serializer{response};
};

/// One request after another of a browser.
class HttpConnection final : public Connection, public std::enable_shared_from_this<HttpConnection> {
public:
    HttpConnection(ServerCore& core, tcp::socket&& socket) : core_(core), stream_(std::move(socket)) {}

    void go_away() override { end(); }
    void read_header(std::chrono::milliseconds timeout);
    void answer(const HttpAnswer& answer);

private:
    void on_header(error_code error);
    /// Why the request has no right to be here; nothing when it has.
    const char* objection() const;
    void serve_get();
    void serve_post();
    void serve_asset(std::string_view path);
    void upgrade();
    void read_body();
    void ask_application();
    void refuse(int status, const std::string& message);

    template <typename Body>
    http::response<Body> prepare(const HttpAnswer& answer) const;
    template <typename Body>
    void send(http::response<Body> response);
    template <typename Body>
    void write(const std::shared_ptr<Writing<Body>>& writing);
    void finish();
    void drain();
    void end();

    std::string_view field(http::field name) const;

    ServerCore& core_;
    beast::tcp_stream stream_;
    beast::flat_buffer buffer_;
    std::optional<http::request_parser<http::string_body>> parser_;
    Target target_;
    bool sets_cookie_ = false; ///< with the answer
    bool uploads_ = false;     ///< counted in ServerCore::uploads
    bool cut_short_ = false;   ///< the request was not read to its end: nothing can follow it
    bool ended_ = false;
};

} // namespace plisse::studio
