#pragma once

namespace plisse {

/// What the program's exit codes mean.
enum class ExitCode {
    done = 0,
    failed = 1,        ///< not converged, intersections found, a disk that is full ...; what was computed is saved
    unusable = 2,      ///< arguments or input that cannot be used
    interrupted = 130, ///< Ctrl-C
};

/// Thrown by a subcommand's callback to end the program with another code than 0, after it has said why.
struct ExitStatus {
    ExitCode code;
};

} // namespace plisse
