#pragma once

#include <atomic>

namespace wedge::app {

/// While it lives, the first SIGINT or SIGTERM sets a flag in place of ending the program; a second one ends it at once
/// with status 130. Signals that the caller of the program ignores stay ignored. One at a time.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    const std::atomic<bool>& flag() const;
};

} // namespace wedge::app
