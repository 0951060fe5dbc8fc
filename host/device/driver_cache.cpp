#include "host/device/driver_cache.h"

#include "host/device/program_cache.h"

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
    const int file = openLocked(mark, LOCK_EX | LOCK_NB);
    if (file < 0) {
        return true; // or not to be opened: then nobody can tell, and nothing is removed
    }
    ::close(file);
    return false;
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
}

void DriverCache::removeMark()
{
    if (file_ < 0) {
        return;
    }
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
