// Signals as terminals, shells and service managers send them: what was rendered is written.
#include "tests/app_testing.h"

#include <pty.h>

namespace wedge::app::test {
namespace {

const Arguments endless = { "render", box, "--method", "mc", "--spp", "1000000", "--size", "256x256", "--verbose", "-o",
    "a.exr", "-o", "b.png", "--report", "r.json" };
const std::vector<std::string> all = { "a.exr", "b.png", "r.json" };

/// Sends the signals at once: none of them is seen before the last one is sent.
void sendAll(const Workplace& place, pid_t process, const std::vector<int>& signals)
{
    waitUntilRendering(place, process);
    kill(process, SIGSTOP);
    for (const int signal : signals) {
        kill(process, signal);
    }
    kill(process, SIGCONT);
}

void checkStopped(const Workplace& place, const Outcome& outcome)
{
    CHECK(outcome.status == 130);
    CHECK(contains(outcome.err, "wedge: interrupted at"));
    CHECK(place.files() == all);
    CHECK(std::get<int>(place.exr("a.exr").metadata.at("complete")) == 0);
}

TEST_CASE("a hangup, SIGTERM and an interrupt stop sampling, and the outputs are written")
{
    for (const int signal : { SIGHUP, SIGTERM, SIGINT }) {
        CAPTURE(signal);
        const Workplace place;
        checkStopped(place, place.run(endless, [&](pid_t process) { sendAll(place, process, { signal }); }));
    }
}

TEST_CASE("further hangups do nothing, and a hangup does not make the next signal the second one")
{
    for (const int signal : { SIGHUP, SIGTERM }) {
        CAPTURE(signal);
        const Workplace place;
        const Outcome outcome = place.run(endless, [&](pid_t process) {
            sendAll(place, process, { SIGHUP, signal });
            while (kill(process, SIGHUP) == 0) {
                siginfo_t ended {};
                waitid(P_PID, static_cast<id_t>(process), &ended, WEXITED | WNOHANG | WNOWAIT);
                if (ended.si_pid != 0) {
                    break;
                }
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        });
        checkStopped(place, outcome);
    }
}

TEST_CASE("the second of SIGINT and SIGTERM ends the program at once")
{
    const Workplace place;
    const Outcome outcome = place.run(endless, [&](pid_t process) { sendAll(place, process, { SIGINT, SIGTERM }); });
    CHECK(outcome.status == 130);
    CHECK(outcome.err == "");
    CHECK(place.files().empty());
}

TEST_CASE("a hangup that is ignored at the start is ignored")
{
    Workplace place;
    place.ignoreHangups = true;
    Arguments limited = endless;
    limited.insert(limited.end(), { "--time-limit", "1" });
    const Outcome outcome = place.run(limited, [&](pid_t process) { sendAll(place, process, { SIGHUP }); });
    CHECK(outcome.status == 0);
    CHECK(contains(outcome.err, "time limit reached"));
    CHECK(place.files() == all);
}

TEST_CASE("a terminal that closes takes no picture with it")
{
    const Workplace place;
    int terminal = -1;
    const pid_t process = forkpty(&terminal, nullptr, nullptr, nullptr);
    REQUIRE(process >= 0);
    if (process == 0) {
        std::vector<char*> argv = { const_cast<char*>(program.c_str()) };
        for (const std::string& argument : endless) {
            argv.push_back(const_cast<char*>(argument.c_str()));
        }
        argv.push_back(nullptr);
        signal(SIGHUP, SIG_DFL);
        if (chdir(place.path().c_str()) == 0) {
            execv(program.c_str(), argv.data());
        }
        _exit(127);
    }
    std::string said;
    std::array<char, 4096> part {};
    for (ssize_t size = 1; size > 0 && !contains(said, "rendering");) {
        size = read(terminal, part.data(), part.size());
        said.append(part.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    }
    CHECK(contains(said, "rendering")); // the progress line
    close(terminal);
    int status = 0;
    REQUIRE(waitpid(process, &status, 0) == process);
    CAPTURE(status);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 130);
    CHECK(place.files() == all);
    CHECK(std::get<int>(place.exr("a.exr").metadata.at("complete")) == 0);
}

} // namespace
} // namespace wedge::app::test
