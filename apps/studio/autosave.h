#pragma once

#include <chrono>
#include <memory>

#include <plisse/steer/session.h>

#include "session_folder.h"

namespace plisse::studio {

/// Keeps a session in the session's folder while it goes on, so that whatever ends the program loses no more than the
/// running step: the scene NAME.json and its edit log. Opened again, it makes the same steps.
class Autosave {
public:
    static constexpr const char* name = "last-session";

    explicit Autosave(const SessionFolder& folder) : folder_(folder) {}

    /// From here on the session is kept once it is other than now.
    void begin(Session& session) { kept_ = state_of(session); }
    /// Writes the session where it has changed. Unless it must be now, it waits until writing has taken no more than a
    /// twentieth of the time. Throws std::runtime_error when the files cannot be written.
    void keep(Session& session, bool now);

private:
    using Clock = std::chrono::steady_clock;
    struct State {
        std::shared_ptr<const Scene> first;
        EditLog edits;
        int level = 0, steps = 0;
        bool operator==(const State&) const = default;
    };
    static State state_of(Session& session);

    const SessionFolder& folder_;
    State kept_;
    std::shared_ptr<const Scene> written_; ///< the scene that the file holds
    Clock::time_point next_{};
};

} // namespace plisse::studio
