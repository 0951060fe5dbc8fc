// Which files a result is made from, so that none of them is written over.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wedge {

/// A file that openFile() was asked for and found.
struct FileOpened {
    std::filesystem::path path;
    std::string kind; ///< as openFile() was told
    bool read = true; ///< false: it may not be read
};

/// Notes, while it lives, which files this process opens with openFile(), or finds and may not read. What any of those
/// that live has noted is not to be written: requireNotOpened().
class FilesOpened {
public:
    FilesOpened();
    ~FilesOpened();
    FilesOpened(const FilesOpened&) = delete;
    FilesOpened& operator=(const FilesOpened&) = delete;

    /// Those that could be read, in their order.
    std::vector<std::filesystem::path> paths() const;
};

/// While it lives, what this thread opens is not noted: it is looked at for what it says of an earlier run, and may be
/// replaced.
class FilesLookedAt {
public:
    FilesLookedAt();
    ~FilesLookedAt();
    FilesLookedAt(const FilesLookedAt&) = delete;
    FilesLookedAt& operator=(const FilesLookedAt&) = delete;
};

/// Adds a file to the notes of every FilesOpened; what openFile() does.
void noteOpened(const FileOpened& file);

/// Whether a path leads to a file that a living FilesOpened has noted, under whatever spelling and through links of
/// either kind. False for what is empty, not there, or no regular file.
bool wasOpened(const std::string& path);

/// Throws UsageError for the first of the paths that wasOpened() is true of. remedy: the way out.
void requireNotOpened(const std::vector<std::string>& written, const std::string& remedy);

} // namespace wedge
