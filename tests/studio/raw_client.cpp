#include "raw_client.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <studio/http_text.h>

namespace plisse::studio {

RawConnection::RawConnection(std::uint16_t port, int receive_buffer)
    : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    if (receive_buffer > 0)
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        throw std::runtime_error("cannot connect");
}

RawConnection::~RawConnection() {
    ::close(socket_);
}

bool RawConnection::send(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent <= 0)
            return false;
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

void RawConnection::finish_sending() {
    ::shutdown(socket_, SHUT_WR);
}

bool RawConnection::receive_some() {
    pollfd ready{socket_, POLLIN, 0};
    const auto milliseconds = std::chrono::duration_cast<std::chrono::milliseconds>(patience).count();
    if (::poll(&ready, 1, static_cast<int>(milliseconds)) != 1)
        return false;
    char bytes[16384];
    const ssize_t got = ::recv(socket_, bytes, sizeof bytes, 0);
    if (got <= 0)
        return false;
    received.append(bytes, static_cast<std::size_t>(got));
    return true;
}

bool RawConnection::is_closed() {
    const auto start = std::chrono::steady_clock::now();
    while (receive_some())
        received.clear();
    return std::chrono::steady_clock::now() - start < patience;
}

RawResponse RawConnection::response() {
    std::size_t end = 0;
    while ((end = received.find("\r\n\r\n")) == std::string::npos)
        if (!receive_some())
            return {};
    RawResponse response;
    response.status = std::stoi(received.substr(9, 3));
    for (std::size_t line = received.find("\r\n") + 2; line < end;) {
        const std::size_t line_end = received.find("\r\n", line);
        const std::size_t colon = received.find(": ", line);
        std::string name = received.substr(line, colon - line);
        std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
        response.fields[name] = received.substr(colon + 2, line_end - colon - 2);
        line = line_end + 2;
    }
    const auto length = response.fields.find("content-length");
    const std::size_t size = length == response.fields.end() ? 0 : std::stoul(length->second);
    while (received.size() < end + 4 + size)
        if (!receive_some())
            return {};
    response.body = received.substr(end + 4, size);
    received.erase(0, end + 4 + size);
    return response;
}

std::string client_frame(int opcode, std::string_view payload, bool final) {
    const std::uint64_t size = payload.size();
    const int digits = size < 126 ? 0 : size < 65536 ? 2 : 8;
    std::string frame(1, static_cast<char>((final ? 0x80 : 0) | opcode));
    frame += static_cast<char>(0x80 | (digits == 0 ? size : digits == 2 ? 126 : 127));
    for (int digit = digits - 1; digit >= 0; --digit)
        frame += static_cast<char>(size >> (8 * digit));
    constexpr std::string_view mask = "\x12\x34\x56\x78";
    frame += mask;
    for (std::size_t i = 0; i < payload.size(); ++i)
        frame += static_cast<char>(payload[i] ^ mask[i % 4]);
    return frame;
}

RawPage::RawPage(std::uint16_t port, const std::string& token, int receive_buffer) : connection(port, receive_buffer) {
    connection.send(request("GET", "/api/session", port, token,
                            "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"));
    status_ = connection.response().status;
}

std::optional<RawFrame> RawPage::frame() {
    std::string& bytes = connection.received;
    const auto has = [&](std::size_t count) {
        while (bytes.size() < count)
            if (!connection.receive_some())
                return false;
        return true;
    };
    for (;;) {
        if (!has(2))
            return std::nullopt;
        std::size_t header = 2;
        std::uint64_t size = static_cast<unsigned char>(bytes[1]);
        if (size >= 126) {
            const std::size_t digits = size == 126 ? 2 : 8;
            header += digits;
            if (!has(header))
                return std::nullopt;
            size = 0;
            for (std::size_t i = 2; i < header; ++i)
                size = size << 8 | static_cast<unsigned char>(bytes[i]);
        }
        if (!has(header + size))
            return std::nullopt;
        RawFrame frame{bytes[0] & 15, (bytes[0] & 0x80) != 0, bytes.substr(header, size)};
        bytes.erase(0, header + size);
        if (frame.opcode != ping_frame)
            return frame;
        connection.send(client_frame(10, frame.payload));
    }
}

std::string request(std::string_view method, std::string_view target, std::uint16_t port, const std::string& token,
                    std::string_view more_lines, std::string_view body) {
    const std::string host = "127.0.0.1:" + std::to_string(port);
    std::string text;
    text.append(method).append(" ").append(target).append(" HTTP/1.1\r\nHost: ").append(host);
    text.append("\r\nOrigin: http://")
        .append(host)
        .append("\r\nCookie: ")
        .append(cookie_name(port))
        .append("=")
        .append(token);
    text.append("\r\n").append(more_lines);
    if (method == "POST")
        text.append("Content-Length: ").append(std::to_string(body.size())).append("\r\n");
    return text.append("\r\n").append(body);
}

RawResponse ask(std::uint16_t port, std::string_view request) {
    RawConnection connection(port);
    connection.send(request);
    return connection.response();
}

} // namespace plisse::studio
