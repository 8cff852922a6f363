#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace plisse::studio {

struct RawResponse {
    int status = 0;                            ///< 0: the connection ended without a whole response
    std::map<std::string, std::string> fields; ///< names in small letters
    std::string body;
};

/// A TCP connection to a port of this machine that sends whatever it is told to. Reading gives up after `patience`.
class RawConnection {
public:
    static constexpr std::chrono::seconds patience{10};

    /// receive_buffer: the kernel's, in bytes; 0: as it comes.
    explicit RawConnection(std::uint16_t port, int receive_buffer = 0);
    ~RawConnection();
    RawConnection(const RawConnection&) = delete;
    RawConnection& operator=(const RawConnection&) = delete;

    /// False when the other end has closed.
    bool send(std::string_view bytes);
    void finish_sending();
    /// At least one byte more in `received`; false at the end of the stream or of patience.
    bool receive_some();
    /// Whether the other end closes within patience, whatever it sends before.
    bool is_closed();
    RawResponse response();

    std::string received; ///< and not used yet

private:
    int socket_ = -1;
};

/// A frame as RFC 6455 lays it out.
struct RawFrame {
    int opcode = 0;
    bool final = true;
    std::string payload;
};

inline constexpr int text_frame = 1, binary_frame = 2, close_frame = 8, ping_frame = 9;

/// The bytes of a masked frame.
std::string client_frame(int opcode, std::string_view payload, bool final = true);

/// A WebSocket over a raw connection.
class RawPage {
public:
    RawPage(std::uint16_t port, const std::string& token, int receive_buffer = 0);

    bool is_open() const { return status_ == 101; }
    bool send_text(std::string_view text) { return connection.send(client_frame(text_frame, text)); }
    /// The next frame; pings are answered and left out. Nothing at the end of the stream or of patience.
    std::optional<RawFrame> frame();

    RawConnection connection;

private:
    int status_ = 0;
};

/// A request with this machine's Host, the cookie and the Origin of the page; more lines as given, each ended by \r\n.
std::string request(std::string_view method, std::string_view target, std::uint16_t port, const std::string& token,
                    std::string_view more_lines = "", std::string_view body = "");

/// One request, one response.
RawResponse ask(std::uint16_t port, std::string_view request);

} // namespace plisse::studio
