#pragma once

#include <atomic>

namespace wedge::app {

/// Call before there are threads: those of the signals below that the program's caller ignores, as nohup does and
/// shells for jobs in the background, stay ignored in all that follows.
void keepIgnoring();

/// While it lives, SIGINT, SIGTERM and SIGHUP set a flag in place of ending the program; the second of SIGINT and
/// SIGTERM ends it at once with status 130. A closed terminal sends several SIGHUPs: further ones do nothing, then nor
/// later. One at a time.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    const std::atomic<bool>& flag() const;
};

} // namespace wedge::app
