#include "host/image/atomic_file.h"

#include "host/error.h"
#include "host/files_opened.h"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace wedge::image {

namespace {

std::string remedyFor(int error)
{
    switch (error) {
    case ENOENT:
        return "create the directory first, or write elsewhere";
    case EACCES:
    case EPERM:
    case EROFS:
        return "check the permissions, or write elsewhere";
    case EISDIR:
        return "give the name of a file in it";
    case ENOSPC:
    case EDQUOT:
        return "free some space, or write elsewhere";
    case ENAMETOOLONG:
        return "use a shorter name";
    case ENXIO:
        return "start what reads the pipe first, or write elsewhere";
    default:
        return "write elsewhere";
    }
}

// The temporary name is short and its own, so that it fits wherever the final name does.
std::string temporaryBeside(const std::filesystem::path& target)
{
    static std::atomic<unsigned> count = 0;
    return (target.parent_path() / fmt::format(".wedge-{}-{}.tmp", getpid(), count++)).string();
}

[[noreturn]] void fail(const std::string& path, int error)
{
    throw Error(fmt::format("cannot write file ({})", std::generic_category().message(error)),
        path.empty() ? "(empty name)" : path, path.empty() ? "give a file name" : remedyFor(error));
}

struct Target {
    std::string path; // with symbolic links followed
    bool direct = false; // a device or a pipe
};

Target targetOf(const std::string& path)
{
    struct stat status = {};
    if (path.empty())
        fail(path, ENOENT);
    if (stat(path.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode))
            fail(path, EISDIR);
        if (S_ISBLK(status.st_mode))
            fail(path, EBUSY);
        if (faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
            fail(path, errno);
        return { behindLinks(path), !S_ISREG(status.st_mode) };
    }
    if (errno != ENOENT)
        fail(path, errno);
    if (path.back() == '/')
        fail(path, EISDIR);
    return { behindLinks(path), false };
}

} // namespace

AtomicFile::AtomicFile(const std::string& path)
    : path_(path)
{
    requireNotOpened({ path }, "write elsewhere");
    const Target target = targetOf(path);
    target_ = target.path;
    direct_ = target.direct;
    tempPath_ = direct_ ? path : temporaryBeside(target_);
    // Without waiting for a reader of a pipe, who may never come.
    const int flags = direct_ ? O_WRONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK : O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
    file_ = open(tempPath_.c_str(), flags, 0666);
    if (file_ < 0)
        fail(path_, errno);
    if (direct_)
        fcntl(file_, F_SETFL, fcntl(file_, F_GETFL) & ~O_NONBLOCK);
}

AtomicFile::~AtomicFile()
{
    if (file_ >= 0)
        close(file_);
    if (!direct_ && !tempPath_.empty())
        unlink(tempPath_.c_str());
}

void AtomicFile::write(std::string_view bytes)
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(file_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR)
            continue;
        if (written < 0)
            fail(path_, errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void AtomicFile::commit()
{
    // Some file systems report a full disk only when the bytes reach it. Pipes and devices cannot be synchronised.
    if (!direct_ && fsync(file_) != 0)
        fail(path_, errno);
    closeFile();
    if (direct_)
        return;
    if (std::rename(tempPath_.c_str(), target_.c_str()) != 0)
        fail(path_, errno);
    tempPath_.clear();
}

void AtomicFile::closeFile()
{
    const int result = close(file_);
    const int error = errno;
    file_ = -1;
    if (result != 0 && error != EINTR)
        fail(path_, error);
}

void checkWritable(const std::string& path)
{
    // Making the temporary file asks every question there is; dropping it leaves nothing behind.
    if (!targetOf(path).direct)
        const AtomicFile probe(path);
}

std::string behindLinks(const std::string& path)
{
    constexpr int most = 40; // as many as Linux follows
    std::filesystem::path name = path;
    std::error_code error;
    for (int i = 0; i < most && std::filesystem::is_symlink(std::filesystem::symlink_status(name, error)); ++i) {
        const std::filesystem::path next = std::filesystem::read_symlink(name, error);
        if (error)
            break;
        name = next.is_absolute() ? next : name.parent_path() / next;
    }
    return name.string();
}

} // namespace wedge::image
