#pragma once

#include <string>
#include <string_view>

namespace wedge::image {

/// An output file that appears whole or not at all: bytes go to a temporary file in the same directory, and commit()
/// renames it. Without a commit the destructor removes the temporary file, and a file that was there stays as it was.
/// The file behind a symbolic link is the one that appears, also where it is not there yet. A path that leads to a
/// device or a pipe (/dev/stdout) is written directly, as it cannot be replaced. Whatever is written, it is no file
/// that was read for it, see requireNotOpened().
class AtomicFile {
public:
    /// Creates the temporary file. Throws Error where the directory is missing or not writable, or the path is a
    /// directory, a disk or a file that may not be written, or a pipe that nobody reads; UsageError where it is a file
    /// that was read.
    explicit AtomicFile(const std::string& path);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    /// Appends the bytes. Throws Error where they do not fit (disk full, file size limit).
    void write(std::string_view bytes);

    /// Makes the bytes safe on disk and gives them the final name. Throws Error where that fails. Call once, last.
    void commit();

    /// Where the bytes go before commit(), for writers that open files by name.
    const std::string& tempPath() const { return tempPath_; }

private:
    void closeFile();

    std::string path_; // as the user gave it, for messages
    std::string target_; // with symbolic links followed: the file behind a link is replaced, not the link
    std::string tempPath_;
    int file_ = -1;
    bool direct_ = false;
};

/// Throws the Error that writing the path would end in, as far as can be told now: call it before the work starts.
/// Leaves no trace, and does not open pipes, whose readers would take that for all there is.
void checkWritable(const std::string& path);

/// The path with the symbolic links of its last part followed, to what is there or would be made.
std::string behindLinks(const std::string& path);

} // namespace wedge::image
