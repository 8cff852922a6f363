#include <plisse/drive/recorder.h>

namespace plisse {

const char* run_status_name(RunStatus status) {
    switch (status) {
    case RunStatus::running:
        return "running";
    case RunStatus::converged:
        return "converged";
    case RunStatus::not_converged:
        return "not-converged";
    case RunStatus::interrupted:
        return "interrupted";
    case RunStatus::failed:
        return "failed";
    }
    return "failed";
}

} // namespace plisse
