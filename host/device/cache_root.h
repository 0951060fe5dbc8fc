// Where the caches of a process lie: programs' (program_cache.h) and the driver's (driver_cache.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace wedge::device {

/// What the environment asks for.
struct WantedCache {
    std::filesystem::path folder; ///< empty: nowhere, or off
    bool off = false;

    /// WEDGE_CACHE_DIR (empty: off), else wedge below XDG_CACHE_HOME, else ~/.cache/wedge, else nowhere.
    static WantedCache fromEnvironment();
    bool operator==(const WantedCache&) const = default;
};

/// The folder of our caches.
struct CacheRoot {
    WantedCache wanted;
    std::filesystem::path folder; ///< empty: there is none
    std::string notice; ///< a line for the user where it is not the one that was wanted; else ""
    std::string failure; ///< why there is none, where one was wanted; else ""

    /// The wanted folder, made where it is not there yet, if our caches can lie in it (ownCacheFolder()) and its disk
    /// has room; else a folder of this user's below the first that takes one of these for temporary files.
    static CacheRoot find(const WantedCache& wanted, const std::vector<std::filesystem::path>& temporaries);

    /// Of this process: found at the first call, which comes before the first call of OpenCL.
    static const CacheRoot& ofProcess();
};

} // namespace wedge::device
