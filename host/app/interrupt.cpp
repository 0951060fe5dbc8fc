#include "host/app/interrupt.h"

#include "host/app/commands.h"

#include <array>
#include <csignal>

#include <unistd.h>

namespace wedge::app {
namespace {

constexpr std::array<int, 3> watched = { SIGINT, SIGTERM, SIGHUP };

std::atomic<bool> interrupted { false }, asked { false }, hungUp { false };
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch it");
std::array<struct sigaction, watched.size()> previous;

extern "C" void onSignal(int signal)
{
    interrupted = true;
    if (signal == SIGHUP) {
        hungUp = true;
    } else if (asked.exchange(true)) {
        _exit(statusInterrupted);
    }
}

} // namespace

void keepIgnoring()
{
    sigset_t ignored;
    sigemptyset(&ignored);
    for (const int signal : watched) {
        struct sigaction action = {};
        if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN) {
            sigaddset(&ignored, signal);
        }
    }
    // Blocked they stay away, whoever handles them: LLVM, which drivers compile with, does without asking.
    pthread_sigmask(SIG_BLOCK, &ignored, nullptr);
}

InterruptGuard::InterruptGuard()
{
    struct sigaction action = {};
    action.sa_handler = onSignal;
    action.sa_flags = SA_RESTART; // drivers don't expect interrupted system calls
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < watched.size(); ++i) {
        sigaction(watched[i], &action, &previous[i]);
    }
}

InterruptGuard::~InterruptGuard()
{
    for (std::size_t i = 0; i < watched.size(); ++i) {
        if (watched[i] == SIGHUP && hungUp) {
            std::signal(SIGHUP, SIG_IGN); // at once: not even for a moment is it what ends the program
        } else {
            sigaction(watched[i], &previous[i], nullptr);
        }
    }
}

const std::atomic<bool>& InterruptGuard::flag() const { return interrupted; }

} // namespace wedge::app
