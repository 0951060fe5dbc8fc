#include "host/file.h"

#include "host/error.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace wedge {

namespace {

[[noreturn]] void failToRead(const std::filesystem::path& path, const std::string& kind, int code)
{
    throw Error(kind + " cannot be read (" + std::strerror(code) + ")", path.string(), "check its permissions");
}

thread_local FilesOpened* innermost = nullptr;

} // namespace

FilesOpened::FilesOpened()
    : outer_(innermost)
{
    innermost = this;
}

FilesOpened::~FilesOpened() { innermost = outer_; }

OpenFile openFile(const std::filesystem::path& path, const std::string& kind)
{
    // What it is, is asked of the open file: a name may stand for another file a moment later. Not to block, because
    // opening a FIFO waits for who writes to it.
    const int descriptor = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        if (errno == ENOENT || errno == ENOTDIR)
            throw Error(kind + " not found", path.string(), "check the path");
        failToRead(path, kind, errno);
    }
    OpenFile file { std::unique_ptr<std::FILE, CloseFile>(fdopen(descriptor, "rb")), 0 };
    if (!file.stream) {
        const int code = errno;
        close(descriptor);
        failToRead(path, kind, code);
    }
    struct stat status { };
    if (fstat(descriptor, &status) != 0)
        failToRead(path, kind, errno);
    if (S_ISDIR(status.st_mode))
        throw Error(kind + " is a folder", path.string(), "name a file in it");
    if (!S_ISREG(status.st_mode))
        throw Error(kind + " is not a regular file", path.string(), "copy it to a regular file first");
    file.bytes = static_cast<std::uintmax_t>(status.st_size);
    for (FilesOpened* notes = innermost; notes != nullptr; notes = notes->outer_)
        notes->paths_.push_back(path);
    return file;
}

std::string readFile(const std::filesystem::path& path, const std::string& kind, std::uintmax_t limit)
{
    const OpenFile file = openFile(path, kind);
    if (file.bytes > limit)
        throw Error(kind + " is larger than " + std::to_string(limit) + " bytes",
            path.string() + " (" + std::to_string(file.bytes) + " bytes)", "split it or simplify it");
    std::string text(static_cast<std::size_t>(file.bytes), '\0');
    errno = 0;
    if (std::fread(text.data(), 1, text.size(), file.stream.get()) != text.size())
        failToRead(path, kind, errno != 0 ? errno : EIO);
    // What the system makes up as it is read has no size of its own, and would be taken for empty.
    if (std::fgetc(file.stream.get()) != EOF || std::ferror(file.stream.get()) != 0)
        throw Error(kind + " is longer than the system says", path.string(), "copy it to a regular file first");
    return text;
}

} // namespace wedge
