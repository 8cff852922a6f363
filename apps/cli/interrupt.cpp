#include "interrupt.h"

#include <atomic>
#include <csignal>

#include <unistd.h>

#include "exit_status.h"

namespace plisse {

namespace {

// A signal handler can reach nothing but a global; the guard keeps it short-lived.
std::atomic<Context*> listening{nullptr};
static_assert(std::atomic<Context*>::is_always_lock_free);

void on_interrupt(int) {
    Context* context = listening.load();
    if (!context || context->cancelled())
        _exit(static_cast<int>(ExitCode::interrupted));
    context->cancel();
}

} // namespace

InterruptGuard::InterruptGuard(Context& context) {
    listening.store(&context);
    std::signal(SIGINT, on_interrupt);
}

InterruptGuard::~InterruptGuard() {
    std::signal(SIGINT, SIG_DFL);
    listening.store(nullptr);
}

} // namespace plisse
