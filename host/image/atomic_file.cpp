#include "host/image/atomic_file.h"

#include "host/error.h"

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

} // namespace

AtomicFile::AtomicFile(const std::string& path)
    : path_(path)
    , target_(path)
{
    struct stat status = {};
    if (path.empty())
        fail("cannot write file", ENOENT);
    if (stat(path.c_str(), &status) == 0) {
        if (S_ISDIR(status.st_mode))
            fail("cannot write file", EISDIR);
        if (faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
            fail("cannot write file", errno);
        direct_ = !S_ISREG(status.st_mode);
        std::error_code ignored;
        const std::filesystem::path resolved = std::filesystem::canonical(path, ignored);
        if (!direct_ && !resolved.empty())
            target_ = resolved.string();
    } else if (errno != ENOENT) {
        fail("cannot write file", errno);
    } else if (path.back() == '/') {
        fail("cannot write file", EISDIR);
    }
    tempPath_ = direct_ ? path : temporaryBeside(target_);
    const int flags = direct_ ? O_WRONLY | O_CLOEXEC : O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
    file_ = open(tempPath_.c_str(), flags, 0666);
    if (file_ < 0)
        fail("cannot write file", errno);
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
            fail("cannot write file", errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void AtomicFile::commit()
{
    // Some file systems report a full disk only when the bytes reach it. Pipes and devices cannot be synchronised.
    if (!direct_ && fsync(file_) != 0)
        fail("cannot write file", errno);
    closeFile();
    if (direct_)
        return;
    if (std::rename(tempPath_.c_str(), target_.c_str()) != 0)
        fail("cannot write file", errno);
    tempPath_.clear();
}

void AtomicFile::closeFile()
{
    const int result = close(file_);
    const int error = errno;
    file_ = -1;
    if (result != 0 && error != EINTR)
        fail("cannot write file", error);
}

void AtomicFile::fail(const std::string& what, int error) const
{
    throw Error(fmt::format("{} ({})", what, std::generic_category().message(error)),
        path_.empty() ? "(empty name)" : path_, path_.empty() ? "give a file name" : remedyFor(error));
}

void checkWritable(const std::string& path)
{
    // Making the temporary file asks every question there is; dropping it leaves nothing behind.
    const AtomicFile probe(path);
}

} // namespace wedge::image
