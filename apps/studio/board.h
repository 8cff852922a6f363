#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <plisse/base/types.h>

#include "server.h"

namespace plisse::studio {

/// What pages have been told that still holds. It tells every page at once, and tells a page that joins all of it, on
/// any thread, whatever the solver is at.
class Board {
public:
    /// One state of a run that is shown, and the mesh it belongs to.
    struct Picture {
        std::uint32_t version = 0; ///< of the mesh
        std::shared_ptr<const Bytes> mesh, positions;
    };
    /// What may be looked at again: a state that was saved.
    struct SavedFrame {
        std::string json; ///< its entry in the list
        Picture picture;
        int level = 0;
        double t = 0;                               ///< s
        std::shared_ptr<const Positions> positions; ///< of the level, exact
    };

    /// The server must outlive what is done here.
    void connect(Server& server) { server_ = &server; }

    void join(ClientId client);
    void leave(ClientId client);

    /// Tells all, and keeps it until another text of this kind comes.
    void tell(const std::string& kind, std::string json);
    /// Tells all, and forgets it.
    void mention(std::string json) { server_->send_text_to_all(std::move(json)); }
    void answer(ClientId client, std::string json) { server_->send_text(client, std::move(json)); }

    /// Adds to the curves; keeps as many, and tells pages what they are now.
    void add_sample(std::string json);
    void cut_samples(std::size_t count);
    std::size_t sample_count() const;

    /// The same of saved states.
    void add_frame(SavedFrame frame);
    void cut_frames(std::size_t count);
    std::size_t frame_count() const;
    std::vector<SavedFrame> frames_of(int level) const;

    /// What a page sees that has asked for nothing else.
    void set_picture(Picture picture);
    /// Shows something to one page.
    void show(ClientId client, const Picture& picture);
    /// Shows a saved frame; false when there is none with this index.
    bool show_frame(ClientId client, std::size_t index);
    std::vector<ClientId> clients() const;

private:
    std::string samples_json() const;
    std::string frames_json(std::size_t from) const;
    void show_locked(ClientId client, const Picture& picture);

    Server* server_ = nullptr;
    mutable std::mutex mutex_;
    std::map<ClientId, std::uint32_t> mesh_of_client_; ///< version of the mesh sent last; 0: none
    std::map<std::string, std::string> texts_;         ///< by kind
    std::vector<std::string> samples_;
    std::vector<SavedFrame> frames_;
    std::size_t sample_count_ = 0, frame_count_ = 0; ///< that belong to the state; what lies beyond may come back
    Picture picture_;
};

} // namespace plisse::studio
