#include "host/device/cache_root.h"

#include "host/device/cache_folder.h"

#include <cstdlib>
#include <fmt/format.h>
#include <utility>

namespace wedge::device {
namespace {

namespace fs = std::filesystem;

constexpr const char* choose = "set WEDGE_CACHE_DIR to a folder that can be written";

/// A variable's value; "" where it is not set.
std::string valueOf(const char* variable)
{
    const char* value = std::getenv(variable);
    return value == nullptr ? "" : value;
}

std::vector<fs::path> temporaryFolders()
{
    std::vector<fs::path> folders;
    if (const std::string chosen = valueOf("TMPDIR"); !chosen.empty()) {
        folders.emplace_back(chosen);
    }
    folders.emplace_back("/tmp");
    return folders;
}

std::string because(const fs::path& folder, const std::string& reason)
{
    return fmt::format("{} ({})", folder.string(), reason);
}

/// "" where caches can lie below the folder.
std::string whyNot(const fs::path& folder)
{
    std::string reason = ownCacheFolder(folder).reason;
    return reason.empty() && lacksRoom(folder) ? "its disk is full, or almost" : reason;
}

} // namespace

WantedCache WantedCache::fromEnvironment()
{
    if (const char* chosen = std::getenv("WEDGE_CACHE_DIR")) {
        return { chosen, *chosen == '\0' };
    }
    if (const std::string caches = valueOf("XDG_CACHE_HOME"); !caches.empty()) {
        return { fs::path(caches) / "wedge", false };
    }
    const std::string home = valueOf("HOME");
    return { home.empty() ? fs::path() : fs::path(home) / ".cache" / "wedge", false };
}

CacheRoot CacheRoot::find(const WantedCache& wanted, const std::vector<fs::path>& temporaries)
{
    if (wanted.off) {
        return { wanted, "", "", "" };
    }
    const std::string reason = wanted.folder.empty() ? "" : whyNot(wanted.folder);
    if (!wanted.folder.empty() && reason.empty()) {
        return { wanted, wanted.folder, "", "" };
    }
    std::string tried = wanted.folder.empty() ? "HOME is not set, or empty" : because(wanted.folder, reason);
    for (const fs::path& temporary : temporaries) {
        const FolderOrReason own = ownTemporaryFolder(temporary);
        const std::string refused = own.folder.empty() ? own.reason : whyNot(own.folder);
        if (refused.empty()) {
            return { wanted, own.folder,
                fmt::format("no folder for compiled kernels: {}: {} is used; {}", tried, own.folder.string(), choose),
                "" };
        }
        tried += ", " + because(own.folder.empty() ? temporary : own.folder, refused);
    }
    if (!wanted.folder.empty() && !ownCacheFolder(wanted.folder).folder.empty()) {
        return { wanted, wanted.folder,
            fmt::format("no disk has room for compiled kernels, without which drivers may fail: {}: make room, or {}",
                tried, choose),
            "" };
    }
    return { wanted, {}, "", tried };
}

const CacheRoot& CacheRoot::ofProcess()
{
    static const CacheRoot root = find(WantedCache::fromEnvironment(), temporaryFolders());
    return root;
}

} // namespace wedge::device
