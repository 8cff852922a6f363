#include "autosave.h"

namespace plisse::studio {

Autosave::State Autosave::state_of(Session& session) {
    return {session.first_scene(), session.edits(), session.run().level(), session.steps()};
}

void Autosave::keep(Session& session, bool now) {
    const auto begin = Clock::now();
    State state = state_of(session);
    if (state == kept_ || (!now && begin < next_))
        return;
    if (written_ == state.first)
        folder_.save_edits(name, session.ended_edits());
    else
        folder_.save(name, *state.first, session.ended_edits());
    written_ = state.first;
    kept_ = std::move(state);
    const auto end = Clock::now();
    next_ = end + 19 * (end - begin);
}

} // namespace plisse::studio
