#include "outbox.h"

namespace plisse::studio {

namespace {

using Bytes = std::vector<unsigned char>;

std::span<const unsigned char> bytes_of(const std::string& text) {
    return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

} // namespace

bool Outbox::push_text(std::shared_ptr<const std::string> text) {
    if (texts_ + 1 > limits_.text_messages || text_bytes_ + text->size() > limits_.text_bytes)
        return false;
    ++texts_;
    text_bytes_ += text->size();
    queue_.push_back({Message::Kind::text, bytes_of(*text), std::move(text)});
    return true;
}

bool Outbox::push_mesh(std::shared_ptr<const Bytes> mesh) {
    if (meshes_ > 0 && mesh_bytes_ + mesh->size() > limits_.mesh_bytes)
        return false;
    drop_positions();
    ++meshes_;
    mesh_bytes_ += mesh->size();
    queue_.push_back({Message::Kind::mesh, *mesh, std::move(mesh)});
    return true;
}

void Outbox::offer_positions(std::shared_ptr<const Bytes> positions) {
    drop_positions();
    positions_ = std::move(positions);
}

std::optional<Outbox::Message> Outbox::next() {
    // The place is emptied by every mesh: what stands in it belongs to the last one given.
    if (positions_ && meshes_ == 0 && (positions_turn_ || queue_.empty())) {
        positions_turn_ = false;
        ++sent_positions_;
        const auto positions = std::move(positions_);
        positions_ = nullptr;
        return Message{Message::Kind::positions, *positions, positions};
    }
    if (queue_.empty())
        return std::nullopt;
    positions_turn_ = true;
    Message message = std::move(queue_.front());
    queue_.pop_front();
    if (message.kind == Message::Kind::text) {
        --texts_;
        text_bytes_ -= message.bytes.size();
    } else {
        --meshes_;
        mesh_bytes_ -= message.bytes.size();
    }
    return message;
}

void Outbox::clear() {
    drop_positions();
    queue_.clear();
    texts_ = text_bytes_ = meshes_ = mesh_bytes_ = 0;
}

void Outbox::drop_positions() {
    if (positions_)
        ++replaced_positions_;
    positions_ = nullptr;
}

} // namespace plisse::studio
