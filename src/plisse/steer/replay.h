#pragma once

#include <plisse/drive/run.h>
#include <plisse/steer/session.h>

namespace plisse {

/// Steps a session that has just begun through the edits of a log, up to the last of them. False when that is
/// cancelled, or a refinement of the log fails. Throws InputError for edits that the run cannot take over.
bool follow(Session& session, const EditLog& log);

/// Runs a scene with the edits of a log, each between the steps at which it was made, or where the level is at rest
/// before that; ends where the log says so, else as run() does. Throws InputError for edits that the run cannot take
/// over, as well as for what run() does.
RunResult replay(const Scene& scene, const EditLog& log, const RunOptions& options, Recorder& recorder,
                 Context& context);

} // namespace plisse
