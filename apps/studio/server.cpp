#include "server.h"

#include <array>
#include <cerrno>
#include <system_error>

#include <sys/random.h>

#include <nlohmann/json.hpp>

#include "page_connection.h"

namespace plisse::studio {

HttpAnswer refusal(int status, const std::string& message) {
    const nlohmann::json body = {{"ok", false}, {"message", message}};
    HttpAnswer answer;
    answer.status = status;
    answer.body = body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return answer;
}

std::string random_token() {
    std::array<unsigned char, 16> random{};
    for (std::size_t filled = 0; filled < random.size();) {
        const ssize_t got = ::getrandom(random.data() + filled, random.size() - filled, 0);
        if (got < 0 && errno != EINTR)
            throw std::system_error(errno, std::generic_category(), "getrandom");
        filled += got > 0 ? static_cast<std::size_t>(got) : 0;
    }
    constexpr std::string_view digits = "0123456789abcdef";
    std::string token;
    for (const unsigned char byte : random) {
        token += digits[byte >> 4];
        token += digits[byte & 15];
    }
    return token;
}

Server::Server(ServerOptions options, Application& application) {
    if (options.token.empty())
        options.token = random_token();
    core_ = std::make_shared<ServerCore>(std::move(options), application);
}

Server::~Server() = default;

void Server::run() {
    core_->run();
}

void Server::stop() noexcept {
    core_->stop();
}

std::uint16_t Server::port() const {
    return core_->port;
}

std::string Server::url() const {
    return "http://127.0.0.1:" + std::to_string(core_->port) + "/?token=" + core_->options.token;
}

ServerCounters Server::counters() const {
    return core_->counters();
}

void Server::send_text(ClientId client, std::string json) {
    if (const auto found = core_->client(client))
        found->change_outbox([text = std::make_shared<const std::string>(std::move(json))](Outbox& outbox) {
            return outbox.push_text(text);
        });
}

void Server::send_text_to_all(std::string json) {
    const auto text = std::make_shared<const std::string>(std::move(json));
    for (const auto& client : core_->clients())
        client->change_outbox([&](Outbox& outbox) { return outbox.push_text(text); });
}

void Server::send_mesh(ClientId client, std::shared_ptr<const Bytes> message) {
    if (const auto found = core_->client(client))
        found->change_outbox([&](Outbox& outbox) { return outbox.push_mesh(std::move(message)); });
}

void Server::offer_positions(ClientId client, std::shared_ptr<const Bytes> message) {
    if (const auto found = core_->client(client))
        found->change_outbox([&](Outbox& outbox) {
            outbox.offer_positions(std::move(message));
            return true;
        });
}

} // namespace plisse::studio
