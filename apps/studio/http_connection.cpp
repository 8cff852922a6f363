#include "http_connection.h"

#include <limits>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "page_connection.h"

namespace plisse::studio {

namespace {

constexpr const char* session_path = "/api/session";
constexpr int uploads_at_a_time = 2;
/// How long a refused request may go on to send: were it cut off at once, its sender would not see the answer.
constexpr std::chrono::seconds linger{5};

std::string_view from_beast(beast::string_view text) {
    return {text.data(), text.size()};
}

/// Whether the socket is to blame, not what came through it.
bool is_of_the_socket(error_code error) {
    return error && error.category() != http::make_error_code(http::error::bad_method).category();
}

HttpAnswer asset_answer(const Asset& asset) {
    HttpAnswer answer;
    answer.content_type = asset.mime_type;
    answer.body.assign(reinterpret_cast<const char*>(asset.bytes.data()), asset.bytes.size());
    return answer;
}

/// The state behind a Reply: takes the first call to the server's thread, if there still is one.
class PendingReply {
public:
    PendingReply(const std::shared_ptr<ServerCore>& core, const std::shared_ptr<HttpConnection>& connection)
        : core_(core), connection_(connection) {}
    ~PendingReply() { give(refusal(500, "the request was not answered")); }
    PendingReply(const PendingReply&) = delete;
    PendingReply& operator=(const PendingReply&) = delete;

    void give(HttpAnswer answer) {
        if (given_.exchange(true))
            return;
        if (const auto core = core_.lock())
            asio::post(core->context, [connection = connection_, answer = std::move(answer)] {
                if (const auto open = connection.lock())
                    open->answer(answer);
            });
    }

private:
    std::weak_ptr<ServerCore> core_;
    std::weak_ptr<HttpConnection> connection_;
    std::atomic<bool> given_{false};
};

/// A file to be streamed; invalid when it cannot be.
http::file_body::value_type open_file(const std::filesystem::path& path) {
    http::file_body::value_type body;
    const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    struct stat status {};
    if (file < 0 || ::fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
        if (file >= 0)
            ::close(file);
        return body;
    }
    beast::file_posix owner;
    owner.native_handle(file);
    error_code error;
    body.reset(std::move(owner), error);
    return error ? http::file_body::value_type{} : std::move(body);
}

} // namespace

void HttpConnection::read_header(std::chrono::milliseconds timeout) {
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(core_.options.header_bytes));
    // serve_post looks at the length itself, and says what is taken.
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());
    stream_.expires_after(timeout);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](error_code error, std::size_t) { self->on_header(error); });
}

void HttpConnection::on_header(error_code error) {
    if (ended_)
        return;
    cut_short_ = error || !parser_->is_done();
    sets_cookie_ = false;
    if (error == http::error::header_limit)
        return refuse(431, "the header is too long");
    if (error == http::error::end_of_stream || error == http::error::partial_message || is_of_the_socket(error))
        return end();
    if (error)
        return refuse(400, "this is no HTTP request");
    const auto target = parse_target(from_beast(parser_->get().target()));
    if (!target)
        return refuse(400, "this is no path");
    target_ = *target;
    if (const char* why = objection()) {
        ++core_.refused;
        return refuse(403, why);
    }
    if (parser_->get().method() == http::verb::get)
        serve_get();
    else if (parser_->get().method() == http::verb::post)
        serve_post();
    else {
        cut_short_ = true; // after a HEAD, the body of the answer would be taken for the next one
        refuse(405, "only GET and POST are understood");
    }
}

std::string_view HttpConnection::field(http::field name) const {
    return from_beast(parser_->get()[name]);
}

const char* HttpConnection::objection() const {
    const auto& request = parser_->get();
    const std::string port = ":" + std::to_string(core_.port);
    const std::string_view host = field(http::field::host);
    if (request.count(http::field::host) != 1 || (host != "127.0.0.1" + port && host != "localhost" + port))
        return "this server is for this machine alone";
    const bool must_say_whence = request.method() == http::verb::post || target_.path == session_path;
    const std::size_t origins = request.count(http::field::origin);
    if (origins > 1 || (origins == 0 && must_say_whence) ||
        (origins == 1 && field(http::field::origin) != "http://" + std::string(host)))
        return "another page may not ask this";
    const auto shown = target_.query.find("token");
    const bool is_allowed = target_.path == "/" && shown != target_.query.end()
                                ? is_same_secret(shown->second, core_.options.token)
                                : has_cookie(field(http::field::cookie), cookie_name(core_.port), core_.options.token);
    return is_allowed ? nullptr : "open the address that plisse studio has printed";
}

void HttpConnection::serve_get() {
    if (!parser_->is_done())
        return refuse(400, "a GET has no body");
    if (target_.path == session_path)
        return upgrade();
    if (target_.path.starts_with("/api/"))
        return ask_application();
    sets_cookie_ = target_.path == "/" && target_.query.contains("token");
    serve_asset(target_.path == "/" ? "index.html" : std::string_view(target_.path).substr(1));
}

void HttpConnection::serve_asset(std::string_view path) {
    for (const Asset& asset : core_.options.assets)
        if (asset.path == path)
            return answer(asset_answer(asset));
    refuse(404, "there is nothing of this name");
}

void HttpConnection::serve_post() {
    const auto limit = core_.options.uploads.find(target_.path);
    if (limit == core_.options.uploads.end())
        return refuse(405, "nothing can be sent here");
    const auto length = parser_->content_length();
    if (!length)
        return refuse(411, "the length of what is sent must be said first");
    if (*length > limit->second)
        return refuse(413, "this is too much; at most " + std::to_string(limit->second) + " bytes are taken");
    if (core_.uploads >= uploads_at_a_time)
        return refuse(503, "other uploads are not finished; try again");
    ++core_.uploads;
    uploads_ = true;
    read_body();
}

void HttpConnection::read_body() {
    if (parser_->is_done()) {
        cut_short_ = false;
        return ask_application();
    }
    stream_.expires_after(core_.options.stall_timeout);
    http::async_read_some(stream_, buffer_, *parser_, [self = shared_from_this()](error_code error, std::size_t) {
        if (error)
            self->end();
        else
            self->read_body();
    });
}

void HttpConnection::ask_application() {
    HttpRequest request{std::string(from_beast(parser_->get().method_string())), target_.path, target_.query,
                        std::move(parser_->get().body())};
    const auto pending = std::make_shared<PendingReply>(core_.shared_from_this(), shared_from_this());
    stream_.expires_never();
    try {
        core_.application.on_request(std::move(request),
                                     [pending](HttpAnswer answer) { pending->give(std::move(answer)); });
    } catch (const std::exception& error) {
        pending->give(refusal(500, error.what()));
    }
}

void HttpConnection::upgrade() {
    const auto& request = parser_->get();
    if (!websocket::is_upgrade(request))
        return refuse(426, "this is the address of a WebSocket");
    if (buffer_.size() > 0)
        return refuse(400, "a WebSocket must wait for its handshake");
    const auto page = std::make_shared<PageConnection>(core_, std::move(stream_));
    core_.add(page);
    page->accept(parser_->release());
    end();
}

void HttpConnection::refuse(int status, const std::string& message) {
    answer(refusal(status, message));
}

void HttpConnection::answer(const HttpAnswer& answer) {
    if (ended_)
        return;
    if (uploads_)
        --core_.uploads;
    uploads_ = false;
    if (answer.file.empty()) {
        http::response<http::string_body> response = prepare<http::string_body>(answer);
        response.body() = answer.body;
        return send(std::move(response));
    }
    http::file_body::value_type file = open_file(answer.file);
    if (!file.is_open())
        return refuse(404, "this file is not there");
    http::response<http::file_body> response = prepare<http::file_body>(answer);
    response.body() = std::move(file);
    send(std::move(response));
}

template <typename Body>
http::response<Body> HttpConnection::prepare(const HttpAnswer& answer) const {
    http::response<Body> response(static_cast<http::status>(answer.status), 11);
    response.keep_alive(!cut_short_ && parser_->get().keep_alive());
    response.set(http::field::content_type, answer.content_type);
    response.set(http::field::cache_control, "no-store");
    response.set("Referrer-Policy", "no-referrer");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    const std::string port = std::to_string(core_.port);
    response.set("Content-Security-Policy",
                 "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; connect-src 'self' "
                 "ws://127.0.0.1:" +
                     port + " ws://localhost:" + port +
                     "; worker-src 'self' blob:; object-src 'none'; base-uri 'none'; form-action 'none'; "
                     "frame-ancestors 'none'");
    if (!answer.download_name.empty())
        response.set(http::field::content_disposition,
                     "attachment; filename=\"" + safe_download_name(answer.download_name) + "\"");
    if (sets_cookie_)
        response.set(http::field::set_cookie,
                     cookie_name(core_.port) + "=" + core_.options.token + "; Path=/; HttpOnly; SameSite=Strict");
    return response;
}

template <typename Body>
void HttpConnection::send(http::response<Body> response) {
    response.prepare_payload();
    write(std::make_shared<Writing<Body>>(std::move(response)));
}

template <typename Body>
void HttpConnection::write(const std::shared_ptr<Writing<Body>>& writing) {
    stream_.expires_after(core_.options.stall_timeout);
    http::async_write_some(stream_, writing->serializer,
                           [self = shared_from_this(), writing](error_code error, std::size_t) {
                               if (error || self->ended_)
                                   self->end();
                               else if (!writing->serializer.is_done())
                                   self->write(writing);
                               else if (writing->response.keep_alive())
                                   self->read_header(self->core_.options.idle_timeout);
                               else
                                   self->finish();
                           });
}

void HttpConnection::finish() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    stream_.expires_after(linger);
    drain();
}

void HttpConnection::drain() {
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(std::size_t{64} << 10),
                            [self = shared_from_this()](error_code error, std::size_t) {
                                if (error || self->ended_)
                                    self->end();
                                else
                                    self->drain();
                            });
}

void HttpConnection::end() {
    if (ended_)
        return;
    ended_ = true;
    if (uploads_)
        --core_.uploads;
    stream_.close();
    core_.remove(shared_from_this());
}

} // namespace plisse::studio
