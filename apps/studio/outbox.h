#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plisse::studio {

/// What one client is still to be sent, in the order that Server promises. Not safe from two threads at once.
class Outbox {
public:
    /// A page is out of step for good when it exceeds one of these.
    struct Limits {
        std::size_t text_messages, text_bytes, mesh_bytes;
    };
    struct Message {
        enum class Kind { text, mesh, positions };
        Kind kind;
        std::span<const unsigned char> bytes;
        std::shared_ptr<const void> owner; ///< of the bytes
    };

    explicit Outbox(const Limits& limits) : limits_(limits) {}

    /// False when it exceeds a limit; the message is not taken then.
    bool push_text(std::shared_ptr<const std::string> text);
    bool push_mesh(std::shared_ptr<const std::vector<unsigned char>> mesh);
    void offer_positions(std::shared_ptr<const std::vector<unsigned char>> positions);

    /// Takes out what is to be sent now. Texts and positions take turns, so that neither keeps the other back.
    std::optional<Message> next();
    void clear();

    std::size_t queued_bytes() const { return text_bytes_ + mesh_bytes_; }
    bool has_positions() const { return positions_ != nullptr; }
    std::size_t sent_positions() const { return sent_positions_; }
    std::size_t replaced_positions() const { return replaced_positions_; }

private:
    void drop_positions();

    Limits limits_;
    std::deque<Message> queue_; ///< texts and meshes
    std::size_t texts_ = 0, text_bytes_ = 0;
    std::size_t meshes_ = 0, mesh_bytes_ = 0;
    std::shared_ptr<const std::vector<unsigned char>> positions_;
    bool positions_turn_ = false;
    std::size_t sent_positions_ = 0, replaced_positions_ = 0;
};

} // namespace plisse::studio
