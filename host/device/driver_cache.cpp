#include "host/device/driver_cache.h"

#include "host/device/program_cache.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <vector>

namespace wedge::device {
namespace {

namespace fs = std::filesystem;

constexpr const char* variable = "POCL_CACHE_DIR";
constexpr std::string_view markExtension = ".mark";

/// A file that is open and locked, or neither. The lock goes with the process, however that ends.
int openLocked(const fs::path& path, int how)
{
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file >= 0 && ::flock(file, how) != 0) {
        ::close(file);
        return -1;
    }
    return file;
}

/// Held while marks are set or looked at, so that none appears in between.
class Turn {
public:
    explicit Turn(const fs::path& root)
        : file_(openLocked(root / "driver.lock", LOCK_EX))
    {
    }
    ~Turn()
    {
        if (file_ >= 0) {
            ::close(file_);
        }
    }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    bool held() const { return file_ >= 0; }

private:
    int file_;
};

std::vector<fs::path> marksIn(const fs::path& folder)
{
    std::vector<fs::path> marks;
    std::error_code failed;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
        if (it->path().extension() == markExtension) {
            marks.push_back(it->path());
        }
    }
    return marks;
}

bool isLocked(const fs::path& mark)
{
    const int file = ::open(mark.c_str(), O_RDWR | O_CLOEXEC);
    const bool free = file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) == 0;
    if (file >= 0) {
        ::close(file);
    }
    return !free; // or not to be opened: then nobody can tell, and nothing is removed
}

/// What is in the folder goes, the folder stays: the driver of this process may have been told of it.
void empty(const fs::path& folder)
{
    std::error_code ignored;
    std::vector<fs::path> entries;
    for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end; it.increment(ignored)) {
        entries.push_back(it->path());
    }
    for (const fs::path& entry : entries) {
        fs::remove_all(entry, ignored);
    }
}

// A process that the user ends in the middle of compiling did not die of its cache: it takes its mark along.
constexpr std::array<int, 3> ending = { SIGINT, SIGTERM, SIGHUP };
std::array<char, 4096> markToRemove; // for the handler, which may not allocate
std::array<bool, ending.size()> caught;

extern "C" void endWithoutMark(int signal)
{
    ::unlink(markToRemove.data());
    ::signal(signal, SIG_DFL);
    ::raise(signal);
}

/// Only of signals that would end the process as it is.
void catchEnding(const std::string& mark)
{
    if (mark.size() >= markToRemove.size()) {
        return;
    }
    *std::copy(mark.begin(), mark.end(), markToRemove.begin()) = '\0';
    for (std::size_t i = 0; i < ending.size(); ++i) {
        struct sigaction now { };
        caught[i] = ::sigaction(ending[i], nullptr, &now) == 0 && now.sa_handler == SIG_DFL;
        if (caught[i]) {
            ::signal(ending[i], endWithoutMark);
        }
    }
}

void catchEndingNoMore()
{
    for (std::size_t i = 0; i < ending.size(); ++i) {
        struct sigaction now { };
        if (caught[i] && ::sigaction(ending[i], nullptr, &now) == 0 && now.sa_handler == endWithoutMark) {
            ::signal(ending[i], SIG_DFL);
        }
        caught[i] = false;
    }
}

} // namespace

DriverCache::DriverCache(fs::path root)
    : root_(std::move(root))
{
}

DriverCache& DriverCache::ofProcess()
{
    // Never destroyed: a mark may be set until the process ends.
    static DriverCache& cache = *[] {
        auto* made = new DriverCache(ProgramCache::fromEnvironment().folder());
        const char* users = std::getenv(variable);
        made->recover(users == nullptr ? "" : users);
        std::error_code failed;
        if (users == nullptr && !made->root_.empty()) {
            fs::create_directories(made->folder(), failed);
            if (!failed) {
                ::setenv(variable, made->folder().c_str(), 0);
            }
        }
        return made;
    }();
    return cache;
}

fs::path DriverCache::folder() const { return root_.empty() ? fs::path() : root_ / "driver"; }

void DriverCache::recover(const std::string& users)
{
    if (root_.empty() || marksIn(root_).empty()) {
        return;
    }
    const Turn turn(root_);
    const std::vector<fs::path> marks = marksIn(root_);
    for (const fs::path& mark : marks) {
        if (!turn.held() || isLocked(mark)) {
            return;
        }
    }
    std::error_code ignored;
    for (const fs::path& mark : marks) {
        fs::remove(mark, ignored);
    }
    if (marks.empty()) {
        return;
    }
    const std::string what = "an earlier run ended while the OpenCL driver compiled or fetched kernels";
    if (!users.empty()) {
        notice_ = fmt::format("{}: {}={}: if that happens again, empty this folder", what, variable, users);
        return;
    }
    empty(folder());
    notice_ = fmt::format("{}: its cache may be damaged and was emptied: {}", what, folder().string());
}

void DriverCache::setMark()
{
    std::error_code ignored;
    fs::create_directories(root_, ignored);
    const Turn turn(root_);
    if (!turn.held()) {
        return;
    }
    mark_ = root_ / fmt::format("{}{}", ::getpid(), markExtension);
    file_ = openLocked(mark_, LOCK_EX | LOCK_NB);
    if (file_ >= 0) {
        catchEnding(mark_.string());
    }
}

void DriverCache::removeMark()
{
    if (file_ < 0) {
        return;
    }
    catchEndingNoMore();
    const Turn turn(root_); // who looks at marks sees it locked, or not at all
    std::error_code ignored;
    fs::remove(mark_, ignored);
    ::close(file_);
    file_ = -1;
}

DriverCache::Mark::Mark(DriverCache& cache)
    : cache_(cache)
{
    if (cache_.holders_++ == 0 && !cache_.root_.empty()) {
        cache_.setMark();
    }
}

DriverCache::Mark::~Mark()
{
    if (--cache_.holders_ == 0) {
        cache_.removeMark();
    }
}

} // namespace wedge::device
