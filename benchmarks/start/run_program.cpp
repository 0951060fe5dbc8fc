#include "benchmarks/start/run_program.h"

#include "host/error.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace wedge::benchmark {
namespace {

constexpr std::string_view ours = "WEDGE_CACHE_DIR=", ofPocl = "POCL_CACHE_DIR=";

/// This process may have set PoCL's itself, when it opened a device: the program below sets its own.
std::vector<std::string> environmentWith(const std::filesystem::path& cache)
{
    std::vector<std::string> out { std::string(ours) + cache.string() };
    for (char** variable = environ; *variable != nullptr; ++variable) {
        const std::string_view text(*variable);
        if (!text.starts_with(ours) && !text.starts_with(ofPocl)) {
            out.emplace_back(text);
        }
    }
    return out;
}

std::vector<char*> pointersTo(std::vector<std::string>& strings)
{
    std::vector<char*> out;
    out.reserve(strings.size() + 1);
    for (std::string& s : strings) {
        out.push_back(s.data());
    }
    out.push_back(nullptr);
    return out;
}

std::string textOf(const std::filesystem::path& file)
{
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

} // namespace

double secondsOf(
    const std::string& program, const std::vector<std::string>& arguments, const std::filesystem::path& cache)
{
    std::vector<std::string> words { program }, variables = environmentWith(cache);
    words.insert(words.end(), arguments.begin(), arguments.end());
    const TemporaryFolder folder;
    const std::string said = (folder.path() / "stderr").string();
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, said.c_str(), O_WRONLY | O_CREAT, 0600);
    const auto start = std::chrono::steady_clock::now();
    pid_t process = 0;
    const int failed = ::posix_spawn(
        &process, program.c_str(), &actions, nullptr, pointersTo(words).data(), pointersTo(variables).data());
    ::posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (failed != 0) {
        throw Error("program cannot be started", program, "build the target wedge");
    }
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) { }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        std::string why = textOf(said);
        std::ranges::replace(why, '\n', ' ');
        throw Error("program failed", fmt::format("{}", fmt::join(words, " ")), "mend what it said: " + why);
    }
    return seconds.count();
}

TemporaryFolder::TemporaryFolder()
{
    std::string name = (std::filesystem::temp_directory_path() / "wedge-start-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        throw Error("folder for temporary files", name, "set TMPDIR to one that can be written");
    }
    path_ = name;
}

TemporaryFolder::~TemporaryFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

} // namespace wedge::benchmark
