#pragma once

#include <plisse/base/context.h>

namespace plisse {

/// For as long as the object lives, Ctrl-C cancels the context (the run ends after its step), and a second Ctrl-C ends
/// the program at once. One at a time.
class InterruptGuard {
public:
    explicit InterruptGuard(Context& context);
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;
};

} // namespace plisse
