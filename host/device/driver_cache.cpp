#include "host/device/driver_cache.h"

#include "host/device/cache_folder.h"
#include "host/device/cache_record.h"
#include "host/device/cache_root.h"

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
/// A mark that cannot be opened is of nobody at work, whose are this user's, and must not keep the cache as it is for
/// ever.
bool isLocked(const fs::path& mark)
{
    const int file = ::open(mark.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    const bool locked = file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) != 0;
    if (file >= 0) {
        ::close(file);
    }
    return locked;
}

/// Removes the marks of processes that died, and returns how many those were.
std::size_t removeAll(const std::vector<fs::path>& marks)
{
    std::error_code ignored;
    return static_cast<std::size_t>(
        std::ranges::count_if(marks, [&](const fs::path& mark) { return fs::remove(mark, ignored); }));
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

DriverCache::DriverCache(const fs::path& root)
    : folder_(ownCacheFolder(root).folder)
{
}

DriverCache& DriverCache::ofProcess()
{
    // Never destroyed: a mark may be set until the process ends.
    static DriverCache& cache = *[] {
        auto* made = new DriverCache(CacheRoot::ofProcess().folder);
        const char* users = std::getenv(variable);
        made->recover(users == nullptr ? "" : users);
        if (users == nullptr && !made->folder_.empty()) {
            ::setenv(variable, made->folder_.c_str(), 0);
        }
        return made;
    }();
    return cache;
}

void DriverCache::recover(const std::string& users)
{
    if (folder_.empty()) {
        return;
    }
    const Turn turn(folder_);
    if (!turn.held()) {
        return;
    }
    const std::vector<fs::path> marks = marksIn(folder_);
    const bool othersWork = std::ranges::any_of(marks, isLocked);
    const bool died = !othersWork && removeAll(marks) > 0;
    const std::string what = "an earlier run ended while the OpenCL driver compiled or fetched kernels";
    if (!users.empty()) {
        if (died) {
            notice_ = fmt::format("{}: {}={}: if that happens again, empty this folder", what, variable, users);
        }
        return;
    }
    CacheRecord record(folder_);
    if (died) {
        emptyCacheFolder(folder_);
        notice_ = fmt::format("{}: its cache may be damaged and was emptied: {}", what, folder_.string());
    } else if (!record.isValid() && !othersWork) {
        emptyCacheFolder(folder_);
        notice_ = fmt::format(
            "the record of the OpenCL driver's cache is damaged: the cache was emptied: {}", folder_.string());
    } else if (const std::size_t damaged = record.removeDamaged(othersWork); damaged > 0) {
        forgetKnownKernels(folder_);
        notice_ = fmt::format("the OpenCL driver's cache was damaged: files removed, to be compiled again: {} in {}",
            damaged, folder_.string());
    }
}

void DriverCache::setMark()
{
    const Turn turn(folder_);
    if (!turn.held()) {
        return;
    }
    mark_ = folder_ / markName(::getpid());
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
    const Turn turn(folder_); // who looks at marks sees it locked, or not at all
    if (turn.held()) {
        CacheRecord(folder_).takeIn();
    }
    catchEndingNoMore();
    std::error_code ignored;
    fs::remove(mark_, ignored);
    ::close(file_);
    file_ = -1;
}

DriverCache::Mark::Mark(DriverCache& cache)
    : cache_(cache)
{
    if (cache_.holders_++ == 0 && !cache_.folder_.empty()) {
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
