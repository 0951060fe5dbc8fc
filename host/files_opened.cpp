#include "host/files_opened.h"

#include "host/error.h"

#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include <sys/stat.h>

namespace wedge {

namespace {

using Identity = std::pair<dev_t, ino_t>;

/// Of the regular file that a path leads to. Asked anew each time: a file that was deleted leaves its number to others.
std::optional<Identity> identityOf(const std::filesystem::path& path)
{
    struct stat status { };
    if (path.empty() || stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
        return std::nullopt;
    return Identity(status.st_dev, status.st_ino);
}

/// The notes of those that live, of all threads.
struct Notes {
    std::mutex guard;
    std::map<const FilesOpened*, std::vector<FileOpened>> files;

    /// Of files that have several names the first that was opened.
    std::map<Identity, const FileOpened*> byIdentity() const
    {
        std::map<Identity, const FileOpened*> opened;
        for (const auto& [who, noted] : files) {
            for (const FileOpened& file : noted) {
                if (const auto identity = identityOf(file.path))
                    opened.emplace(*identity, &file);
            }
        }
        return opened;
    }
};

Notes& notes()
{
    static Notes all;
    return all;
}

thread_local int looking = 0;

} // namespace

FilesOpened::FilesOpened()
{
    const std::lock_guard lock(notes().guard);
    notes().files[this];
}

FilesOpened::~FilesOpened()
{
    const std::lock_guard lock(notes().guard);
    notes().files.erase(this);
}

std::vector<std::filesystem::path> FilesOpened::paths() const
{
    const std::lock_guard lock(notes().guard);
    std::vector<std::filesystem::path> paths;
    for (const FileOpened& file : notes().files.at(this)) {
        if (file.read)
            paths.push_back(file.path);
    }
    return paths;
}

FilesLookedAt::FilesLookedAt() { ++looking; }

FilesLookedAt::~FilesLookedAt() { --looking; }

void noteOpened(const FileOpened& file)
{
    if (looking > 0)
        return;
    const std::lock_guard lock(notes().guard);
    for (auto& [who, files] : notes().files)
        files.push_back(file);
}

bool wasOpened(const std::string& path)
{
    const std::lock_guard lock(notes().guard);
    const auto identity = identityOf(path);
    return identity && notes().byIdentity().contains(*identity);
}

void requireNotOpened(const std::vector<std::string>& written, const std::string& remedy)
{
    const std::lock_guard lock(notes().guard);
    const auto opened = notes().byIdentity();
    for (const std::string& path : written) {
        const auto identity = identityOf(path);
        if (const auto found = identity ? opened.find(*identity) : opened.end(); found != opened.end())
            throw UsageError(
                "output is a file that is read, " + found->second->kind + " " + found->second->path.string(), path,
                remedy);
    }
}

} // namespace wedge
