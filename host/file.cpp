#include "host/file.h"

#include "host/error.h"
#include "host/files_opened.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace wedge {

namespace {

constexpr const char* copyIt = "copy it to a regular file first";

std::string remedyFor(int code)
{
    switch (code) {
    case EACCES:
    case EPERM:
        return "check the permissions of it and of its folders";
    case ELOOP:
        return "check the links that it is, or lies behind";
    case ENAMETOOLONG:
        return "use a shorter name";
    case EMFILE:
    case ENFILE:
        return "allow more open files, or close some";
    default:
        return "copy it elsewhere";
    }
}

[[noreturn]] void failToRead(const std::filesystem::path& path, const std::string& kind, int code)
{
    throw Error(kind + " cannot be read (" + std::strerror(code) + ")", path.string(), remedyFor(code));
}

[[noreturn]] void failToOpen(const std::filesystem::path& path, const std::string& kind, int code)
{
    struct stat status { };
    if (code == ENXIO) // a socket
        throw Error(kind + " is not a regular file", path.string(), copyIt);
    if (code == ENOENT && lstat(path.c_str(), &status) == 0 && S_ISLNK(status.st_mode))
        throw Error(kind + " not found (it is a link to what is not there)", path.string(), "check where it leads");
    if (code == ENOENT)
        throw Error(kind + " not found", path.string(), "check the path");
    if (code == ENOTDIR)
        throw Error(kind + " not found (a part of its path is no folder)", path.string(), "check the path");
    if (stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode))
        noteOpened({ .path = path, .kind = kind, .read = false });
    failToRead(path, kind, code);
}

} // namespace

OpenFile openFile(const std::filesystem::path& path, const std::string& kind)
{
    // What it is, is asked of the open file: a name may stand for another file a moment later. Not to block, because
    // opening a FIFO waits for who writes to it.
    const int descriptor = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        failToOpen(path, kind, errno);
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
        throw Error(kind + " is not a regular file", path.string(), copyIt);
    file.bytes = static_cast<std::uintmax_t>(status.st_size);
    noteOpened({ .path = path, .kind = kind });
    return file;
}

std::string readFile(const std::filesystem::path& path, const std::string& kind, std::uintmax_t limit)
{
    const OpenFile file = openFile(path, kind);
    if (file.bytes > limit)
        throw Error(kind + " is larger than " + std::to_string(limit) + " bytes",
            path.string() + " (" + std::to_string(file.bytes) + " bytes)", "split it or simplify it");
    std::string text(static_cast<std::size_t>(file.bytes), '\0');
    std::FILE* stream = file.stream.get();
    const std::size_t count = std::fread(text.data(), 1, text.size(), stream);
    if (std::ferror(stream) != 0)
        failToRead(path, kind, errno);
    if (count < text.size())
        throw Error(kind + " became shorter while it was read", path.string(), "call again when it is whole");
    // What the system makes up as it is read has no size of its own, and would be taken for empty.
    const bool more = std::fgetc(stream) != EOF;
    if (std::ferror(stream) != 0)
        failToRead(path, kind, errno);
    if (more)
        throw Error(kind + " is longer than the system says", path.string(), copyIt);
    return text;
}

} // namespace wedge
