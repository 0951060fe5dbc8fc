#include "host/app/console.h"

#include "host/error.h"

#include <cerrno>
#include <csignal>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace wedge::app {
namespace {

constexpr std::size_t maxLine = 400;
int lostOutput = 0; // errno of the first write to stdout that failed

/// What fails to be written here is lost, and a later call would succeed for want of anything to write.
void flushSaid()
{
    if (std::fflush(stdout) != 0 && lostOutput == 0) {
        lostOutput = errno;
    }
}

void line(std::string_view prefix, std::string_view text)
{
    flushSaid();
    const std::size_t most = maxLine - prefix.size();
    put(stderr, fmt::format("{}{}\n", prefix, shortened(printable(shortened(text, 2 * most)), most)));
}

} // namespace

void prepareProcess()
{
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int stream : { STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO }) {
        if (fcntl(stream, F_GETFD) >= 0 || errno != EBADF) {
            continue;
        }
        // The lowest free number is this one. Opened the wrong way round, so that its use is a failure as before.
        const int flags = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
        if (open("/dev/null", flags) < 0) {
            (void)open("/", O_RDONLY | O_DIRECTORY);
        }
    }
}

void put(std::FILE* stream, std::string_view text)
{
    if (std::fwrite(text.data(), 1, text.size(), stream) < text.size() && stream == stdout && lostOutput == 0) {
        lostOutput = errno;
    }
}

void warn(std::string_view text) { line("wedge: warning: ", text); }

void complain(std::string_view text) { line("wedge: error: ", text); }

void warnOf(const std::vector<std::string>& warnings)
{
    for (const std::string& warning : warnings) {
        warn(warning);
    }
}

void requireSaid()
{
    flushSaid();
    if (lostOutput != 0) {
        throw Error(fmt::format("cannot write to standard output ({})", std::generic_category().message(lostOutput)),
            "the result", "send it elsewhere");
    }
}

} // namespace wedge::app
