#include "host/device/cache_folder.h"

#include "host/device/cache_record.h"

#include <algorithm>
#include <cctype>
#include <fcntl.h>
#include <fmt/format.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace wedge::device {
namespace {

namespace fs = std::filesystem;

constexpr const char* tag = ".made-by-wedge";
constexpr const char* lock = "lock";
constexpr std::string_view markExtension = ".mark";

bool isPlainFile(const fs::path& path, bool empty)
{
    struct stat found { };
    return ::lstat(path.c_str(), &found) == 0 && S_ISREG(found.st_mode) && (!empty || found.st_size == 0);
}

/// A folder and no link to one, of this user, that can be written.
bool isUsable(const fs::path& folder)
{
    struct stat found { };
    return ::lstat(folder.c_str(), &found) == 0 && S_ISDIR(found.st_mode) && found.st_uid == ::geteuid()
        && ::access(folder.c_str(), R_OK | W_OK | X_OK) == 0;
}

bool isMark(const fs::path& path)
{
    const std::string number = path.stem().string();
    return path.extension() == markExtension && !number.empty()
        && std::ranges::all_of(number, [](unsigned char c) { return std::isdigit(c) != 0; }) && isPlainFile(path, true);
}

/// The record goes first: a folder with the tag and without a valid record is taken for damaged.
bool putTag(const fs::path& folder)
{
    const int file =
        CacheRecord::begin(folder) ? ::open((folder / tag).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666) : -1;
    if (file >= 0) {
        ::close(file);
    }
    return file >= 0;
}

bool hasTag(const fs::path& folder) { return isPlainFile(folder / tag, true); }

std::vector<fs::path> entriesOf(const fs::path& folder)
{
    std::vector<fs::path> entries;
    std::error_code failed;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
        entries.push_back(it->path());
    }
    return entries;
}

/// Nothing in it but what adopt() leaves when it is cut short.
bool isUntouched(const fs::path& folder)
{
    return std::ranges::all_of(entriesOf(folder), [](const fs::path& entry) {
        return (CacheRecord::isRecord(entry) || entry.filename() == lock) && isPlainFile(entry, false);
    });
}

bool adopt(const fs::path& folder)
{
    if (!isUntouched(folder)) {
        return hasTag(folder); // that another process may have put in meanwhile
    }
    const Turn turn(folder);
    return turn.held() && (hasTag(folder) || (isUntouched(folder) && putTag(folder)));
}

} // namespace

fs::path ownCacheFolder(const fs::path& root)
{
    if (root.empty()) {
        return {};
    }
    const fs::path folder = root / "wedge-pocl";
    std::error_code failed;
    fs::create_directories(folder, failed); // an error where it is a link, too, which isUsable() finds
    if (!isUsable(folder)) {
        return {};
    }
    return hasTag(folder) || adopt(folder) ? folder : fs::path();
}

int openLocked(const fs::path& path, int how)
{
    const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0 && ::flock(file, how) != 0) {
        ::close(file);
        return -1;
    }
    return file;
}

Turn::Turn(const fs::path& folder)
    : file_(openLocked(folder / lock, LOCK_EX))
{
}

Turn::~Turn()
{
    if (file_ >= 0) {
        ::close(file_);
    }
}

void emptyCacheFolder(const fs::path& folder)
{
    if (!isUsable(folder) || !hasTag(folder)) {
        return;
    }
    std::error_code ignored;
    for (const fs::path& entry : entriesOf(folder)) {
        if (entry.filename() != tag && entry.filename() != lock && !isMark(entry)) {
            fs::remove_all(entry, ignored); // of a link the link alone
        }
    }
    CacheRecord::begin(folder);
}

void forgetKnownKernels(const fs::path& folder)
{
    std::error_code ignored;
    for (const fs::path& entry : entriesOf(folder)) {
        if (entry.filename().string().starts_with(knownKernels) && isPlainFile(entry, true)) {
            fs::remove(entry, ignored);
        }
    }
}

std::vector<fs::path> marksIn(const fs::path& folder)
{
    std::vector<fs::path> marks = entriesOf(folder);
    std::erase_if(marks, [](const fs::path& entry) { return !isMark(entry); });
    return marks;
}

std::string markName(long process) { return fmt::format("{}{}", process, markExtension); }

} // namespace wedge::device
