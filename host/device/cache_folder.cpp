#include "host/device/cache_folder.h"

#include "host/device/cache_record.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <system_error>
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

std::string reasonOf(int error) { return std::generic_category().message(error); }

/// Why it is no folder of this user's that can be written, or "". A link to one is none.
std::string whyUnusable(const fs::path& folder)
{
    struct stat found { };
    if (::lstat(folder.c_str(), &found) != 0) {
        return reasonOf(errno);
    }
    if (S_ISLNK(found.st_mode)) {
        return "it is a link";
    }
    if (!S_ISDIR(found.st_mode)) {
        return reasonOf(ENOTDIR);
    }
    if (found.st_uid != ::geteuid()) {
        return "it is another user's";
    }
    return ::access(folder.c_str(), R_OK | W_OK | X_OK) == 0 ? "" : reasonOf(errno);
}

bool isUsable(const fs::path& folder) { return whyUnusable(folder).empty(); }

/// Why others than this user and the superuser could replace a folder in it, or "".
std::string whyUnsafe(const fs::path& parent)
{
    struct stat found { };
    if (::stat(parent.c_str(), &found) != 0) {
        return reasonOf(errno);
    }
    if (!S_ISDIR(found.st_mode)) {
        return reasonOf(ENOTDIR);
    }
    if (found.st_uid != 0 && found.st_uid != ::geteuid()) {
        return "it is another user's";
    }
    const bool shared = (found.st_mode & (S_IWGRP | S_IWOTH)) != 0;
    return shared && (found.st_mode & S_ISVTX) == 0 ? "others may rename what is in it" : "";
}

/// A folder of this user's to which nobody else has access.
bool isPrivate(const fs::path& folder)
{
    struct stat found { };
    return isUsable(folder) && ::lstat(folder.c_str(), &found) == 0 && (found.st_mode & 0077) == 0;
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

/// Makes a folder ours that is nobody's. Returns why it is not, or "".
std::string adopt(const fs::path& folder)
{
    constexpr const char* others = "it is not of wedge's making";
    if (!isUntouched(folder)) {
        return hasTag(folder) ? "" : others; // that another process may have put in meanwhile
    }
    const Turn turn(folder);
    if (!turn.held()) {
        return reasonOf(errno);
    }
    if (!hasTag(folder) && !isUntouched(folder)) {
        return others;
    }
    return hasTag(folder) || putTag(folder) ? "" : reasonOf(errno);
}

} // namespace

FolderOrReason ownCacheFolder(const fs::path& root)
{
    if (root.empty()) {
        return { {}, "no folder is named" };
    }
    if (std::string reason = whyUnwritable(root); !reason.empty()) {
        return { {}, std::move(reason) };
    }
    const fs::path folder = root / "wedge-pocl";
    if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
        return { {}, reasonOf(errno) };
    }
    if (const std::string reason = whyUnusable(folder); !reason.empty()) {
        return { {}, "its folder wedge-pocl: " + reason };
    }
    if (const std::string reason = hasTag(folder) ? "" : adopt(folder); !reason.empty()) {
        return { {}, "its folder wedge-pocl: " + reason };
    }
    return { folder, "" };
}

FolderOrReason ownTemporaryFolder(const fs::path& temporary)
{
    constexpr int mostNames = 8;
    if (std::string reason = whyUnsafe(temporary); !reason.empty()) {
        return { {}, std::move(reason) };
    }
    const std::string name = fmt::format("wedge-{}", ::geteuid());
    for (int i = 1; i <= mostNames; ++i) {
        fs::path folder = temporary / (i == 1 ? name : fmt::format("{}-{}", name, i));
        if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
            return { {}, reasonOf(errno) };
        }
        if (isPrivate(folder)) {
            return { std::move(folder), "" };
        }
    }
    // Somebody has taken all of them, and cannot foresee this one.
    std::string unforeseen = (temporary / (name + "-XXXXXX")).string();
    return ::mkdtemp(unforeseen.data()) != nullptr ? FolderOrReason { unforeseen, "" }
                                                   : FolderOrReason { {}, reasonOf(errno) };
}

std::string whyUnwritable(const fs::path& folder)
{
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) {
        return failed.message();
    }
    if (!fs::is_directory(folder, failed)) {
        return reasonOf(failed ? failed.value() : ENOTDIR);
    }
    return ::access(folder.c_str(), W_OK | X_OK) == 0 ? "" : reasonOf(errno);
}

bool lacksRoom(const fs::path& folder)
{
    constexpr std::uint64_t least = std::uint64_t { 32 } << 20;
    struct statvfs disk { };
    return ::statvfs(folder.c_str(), &disk) == 0 && std::uint64_t { disk.f_bavail } * disk.f_frsize < least;
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
