#include "board.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace plisse::studio {

void Board::join(ClientId client) {
    const std::lock_guard lock(mutex_);
    mesh_of_client_[client] = 0;
    for (const auto& [kind, json] : texts_)
        server_->send_text(client, json);
    server_->send_text(client, samples_json());
    server_->send_text(client, frames_json(0));
    if (picture_.mesh)
        show_locked(client, picture_);
}

void Board::leave(ClientId client) {
    const std::lock_guard lock(mutex_);
    mesh_of_client_.erase(client);
}

void Board::tell(const std::string& kind, std::string json) {
    const std::lock_guard lock(mutex_);
    texts_[kind] = json;
    server_->send_text_to_all(std::move(json));
}

void Board::add_sample(std::string json) {
    const std::lock_guard lock(mutex_);
    samples_.resize(sample_count_);
    samples_.push_back(json);
    ++sample_count_;
    server_->send_text_to_all(std::move(json));
}

void Board::cut_samples(std::size_t count) {
    const std::lock_guard lock(mutex_);
    sample_count_ = std::min(count, samples_.size());
    server_->send_text_to_all(samples_json());
}

std::size_t Board::sample_count() const {
    const std::lock_guard lock(mutex_);
    return sample_count_;
}

void Board::add_frame(SavedFrame frame) {
    const std::lock_guard lock(mutex_);
    frames_.resize(frame_count_);
    frames_.push_back(std::move(frame));
    ++frame_count_;
    server_->send_text_to_all(frames_json(frame_count_ - 1));
}

void Board::cut_frames(std::size_t count) {
    const std::lock_guard lock(mutex_);
    frame_count_ = std::min(count, frames_.size());
    server_->send_text_to_all(frames_json(0));
}

std::size_t Board::frame_count() const {
    const std::lock_guard lock(mutex_);
    return frame_count_;
}

std::vector<Board::SavedFrame> Board::frames_of(int level) const {
    const std::lock_guard lock(mutex_);
    std::vector<SavedFrame> frames;
    for (std::size_t f = 0; f < frame_count_; ++f)
        if (frames_[f].level == level)
            frames.push_back(frames_[f]);
    return frames;
}

void Board::set_picture(Picture picture) {
    const std::lock_guard lock(mutex_);
    picture_ = std::move(picture);
}

void Board::show(ClientId client, const Picture& picture) {
    const std::lock_guard lock(mutex_);
    show_locked(client, picture);
}

bool Board::show_frame(ClientId client, std::size_t index) {
    const std::lock_guard lock(mutex_);
    if (index >= frame_count_)
        return false;
    show_locked(client, frames_[index].picture);
    return true;
}

void Board::show_locked(ClientId client, const Picture& picture) {
    const auto found = mesh_of_client_.find(client);
    if (found == mesh_of_client_.end())
        return;
    if (found->second != picture.version)
        server_->send_mesh(client, picture.mesh);
    found->second = picture.version;
    if (picture.positions)
        server_->offer_positions(client, picture.positions);
}

std::vector<ClientId> Board::clients() const {
    const std::lock_guard lock(mutex_);
    std::vector<ClientId> clients;
    for (const auto& [client, version] : mesh_of_client_)
        clients.push_back(client);
    return clients;
}

std::string Board::samples_json() const {
    const auto end = samples_.begin() + static_cast<std::ptrdiff_t>(sample_count_);
    return fmt::format(R"({{"type": "samples", "samples": [{}]}})", fmt::join(samples_.begin(), end, ","));
}

std::string Board::frames_json(std::size_t from) const {
    std::vector<std::string> entries;
    for (std::size_t f = from; f < frame_count_; ++f)
        entries.push_back(frames_[f].json);
    return fmt::format(R"({{"type": "frames", "count": {}, "from": {}, "list": [{}]}})", frame_count_, from,
                       fmt::join(entries, ","));
}

} // namespace plisse::studio
