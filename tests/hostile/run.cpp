#include "tests/hostile/row.h"

#include "host/text.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace wedge::hostile {
namespace {

using Clock = std::chrono::steady_clock;

constexpr rlim_t memoryLimit = 500'000'000; // bytes
constexpr std::chrono::seconds patience { 60 }; // who takes longer hangs
constexpr std::size_t longestLine = 400;
constexpr std::size_t mostSaid = 16384; // bytes on stderr
constexpr uid_t nobody = 65534;
constexpr int unreachable = 126; // the program, for an ordinary user

#if defined(__SANITIZE_ADDRESS__)
constexpr bool limits = false; // the shadow memory alone is more
#else
constexpr bool limits = true;
#endif

std::string readAll(const std::filesystem::path& path)
{
    std::ifstream in(path, std::ios::binary);
    return { std::istreambuf_iterator<char>(in), {} };
}

/// A folder to run the program in, beside files for its streams and a folder for temporary files.
class Place {
public:
    Place()
    {
        std::string name = (std::filesystem::temp_directory_path() / "wedge-hostile-XXXXXX").string();
        REQUIRE(mkdtemp(name.data()) != nullptr);
        root = name;
        for (const auto& folder : { root, work(), root / "tmp" }) {
            std::filesystem::create_directory(folder);
            std::filesystem::permissions(folder, std::filesystem::perms(0777));
        }
    }
    ~Place()
    {
        std::error_code ignored;
        std::filesystem::permissions(work(), std::filesystem::perms::owner_all, ignored);
        std::filesystem::remove_all(root, ignored);
    }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    std::filesystem::path work() const { return root / "work"; }

    std::filesystem::path root;
};

void limit(int resource, rlim_t most)
{
    const rlimit both { most, most };
    setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

/// Streams that are to be closed stay open until all others are what they should be.
void connect(int stream, const std::optional<std::string>& path, const std::string& readBack)
{
    if (!path) {
        return;
    }
    const std::string& name = path->empty() ? readBack : *path;
    const int handle = open(name.c_str(), stream == 0 ? O_RDONLY : O_WRONLY | O_CREAT, 0666);
    if (handle < 0 || dup2(handle, stream) != stream) {
        _exit(127);
    }
    close(handle);
}

[[noreturn]] void become(const Row& row, const Place& place, char** argv)
{
    setenv("WEDGE_CACHE_DIR", WEDGE_TEST_CACHE, 1);
    setenv("TMPDIR", (place.root / "tmp").c_str(), 1);
    if (chdir(place.work().c_str()) != 0) {
        _exit(127);
    }
    connect(0, row.start.in, "/dev/null");
    connect(1, row.start.out, place.root / "out");
    connect(2, row.start.err, place.root / "err");
    for (const auto& [stream, path] : { std::pair { 0, row.start.in }, { 1, row.start.out }, { 2, row.start.err } }) {
        if (!path) {
            close(stream);
        }
    }
    if (limits && row.start.limited) {
        limit(row.start.device ? RLIMIT_DATA : RLIMIT_AS, memoryLimit);
    }
    limit(RLIMIT_CORE, 0);
    if (row.start.fileSizeLimit >= 0) {
        limit(RLIMIT_FSIZE, static_cast<rlim_t>(row.start.fileSizeLimit));
    }
    if (row.start.ordinaryUser && geteuid() == 0) {
        if (setgid(nobody) != 0 || setuid(nobody) != 0 || access(WEDGE_PROGRAM, X_OK) != 0) {
            _exit(unreachable);
        }
    }
    execv(WEDGE_PROGRAM, argv);
    _exit(127);
}

struct Outcome {
    bool ended = false;
    int status = -1; ///< exit status, or 1000 + signal
    long kilobytes = 0; ///< resident at most
    double seconds = 0;
    std::string out, err;
};

Outcome start(const Row& row, const Place& place)
{
    std::vector<char*> argv = { const_cast<char*>("wedge") };
    for (const std::string& argument : row.call) {
        argv.push_back(const_cast<char*>(argument.c_str()));
    }
    argv.push_back(nullptr);
    const Clock::time_point begin = Clock::now();
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        become(row, place, argv.data());
    }
    Outcome outcome;
    int status = 0;
    rusage usage {};
    while (!(outcome.ended = wait4(child, &status, WNOHANG, &usage) == child) && Clock::now() - begin < patience) {
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    if (!outcome.ended) {
        kill(child, SIGKILL);
        wait4(child, &status, 0, &usage);
    }
    outcome.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    outcome.kilobytes = usage.ru_maxrss;
    outcome.out = readAll(place.root / "out");
    outcome.err = readAll(place.root / "err");
    return outcome;
}

/// For scripts/measure_hostile.sh: no test asserts a time.
void record(const Row& row, double seconds)
{
    if (const char* times = std::getenv("WEDGE_HOSTILE_TIMES")) {
        std::ofstream(times, std::ios::app) << seconds << '\t' << row.name << '\n';
    }
}

void checkSaid(const Row& row, const Outcome& outcome)
{
    CHECK(outcome.err.size() <= mostSaid);
    std::istringstream lines(outcome.err.substr(0, 2 * mostSaid));
    int errors = 0;
    for (std::string line; std::getline(lines, line);) {
        CAPTURE(line);
        CHECK(line.starts_with("wedge: "));
        CHECK(line.size() <= longestLine);
        CHECK(printable(line) == line);
        CHECK(line.find("fault in wedge") == std::string::npos);
        errors += line.starts_with("wedge: error: ");
    }
    if (row.start.err == "") {
        CHECK(errors == (outcome.status == 0 ? 0 : row.errors));
        CHECK(outcome.err.find(row.says) != std::string::npos);
    }
    CHECK(std::ranges::none_of(outcome.out, [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; }));
}

void checkStatus(const Row& row, const Outcome& outcome)
{
    switch (row.ending) {
    case Ending::Done:
        CHECK(outcome.status == 0);
        break;
    case Ending::Failure:
        CHECK(outcome.status == 1);
        break;
    case Ending::WrongCall:
        CHECK(outcome.status == 2);
        break;
    case Ending::DoneOrFailure:
        CHECK((outcome.status == 0 || outcome.status == 1));
    }
}

/// A file that is there, and whole if it is an image.
void checkMade(const std::filesystem::path& path)
{
    CAPTURE(path.string());
    const std::string bytes = readAll(path);
    CHECK(!bytes.empty());
    if (path.extension() == ".exr") {
        CHECK(bytes.starts_with("\x76\x2f\x31\x01"));
    } else if (path.extension() == ".png") {
        CHECK(bytes.starts_with("\x89PNG"));
        CHECK(bytes.find("IEND") != std::string::npos);
    }
}

} // namespace

void write(const Folder& folder, const std::string& name, const std::string& text)
{
    std::ofstream(folder / name, std::ios::binary) << text;
}

void run(const Row& row)
{
    CAPTURE(row.name);
    const Place place;
    if (row.prepare) {
        row.prepare(place.work());
    }
    const Outcome outcome = start(row, place);
    if (row.start.ordinaryUser && outcome.status == unreachable) {
        MESSAGE("left out, as ordinary users cannot reach the program: ", row.name);
        return;
    }
    record(row, outcome.seconds);
    const std::string err = shortened(printable(shortened(outcome.err, 2000)), 2000);
    CAPTURE(err);
    CHECK(outcome.ended);
    checkStatus(row, outcome);
    checkSaid(row, outcome);
    if (limits && row.start.limited) {
        CHECK(outcome.kilobytes <= static_cast<long>(memoryLimit / 1000));
    }
    for (const auto& entry : std::filesystem::directory_iterator(place.work())) {
        CHECK_FALSE(entry.path().filename().string().starts_with(".wedge-")); // temporary files
    }
    for (const std::string& name : row.makes) {
        checkMade(place.work() / name);
    }
}

} // namespace wedge::hostile
