#include "host/device/no_device.h"

#include "host/device/cache_folder.h"
#include "host/device/cache_root.h"
#include "host/device/cl_error.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>

namespace wedge::device {
namespace {

namespace fs = std::filesystem;

constexpr const char* install = "install an OpenCL driver, such as the package pocl-opencl-icd for the CPU, or your "
                                "GPU vendor's";
constexpr const char* vendors = "/etc/OpenCL/vendors";
constexpr cl_int platformNotFound = -1001; // CL_PLATFORM_NOT_FOUND_KHR

std::string valueOf(const char* variable)
{
    const char* value = std::getenv(variable);
    return value == nullptr ? "" : value;
}

/// Where PoCL keeps what it compiles; what it makes of the environment.
fs::path poclFolder()
{
    if (const std::string chosen = valueOf("POCL_CACHE_DIR"); !chosen.empty()) {
        return chosen;
    }
    if (const std::string caches = valueOf("XDG_CACHE_HOME"); !caches.empty()) {
        return fs::path(caches) / "pocl" / "kcache";
    }
    const std::string home = valueOf("HOME");
    return home.empty() ? fs::path("/tmp/pocl/kcache") : fs::path(home) / ".cache" / "pocl" / "kcache";
}

/// Folders and why PoCL cannot use them, or "".
std::string refusedFolders()
{
    const fs::path folder = poclFolder();
    const std::string reason = whyUnwritable(folder);
    if (reason.empty() && !lacksRoom(folder)) {
        return "";
    }
    const std::string& ours = CacheRoot::ofProcess().failure;
    const bool chosen = !valueOf("POCL_CACHE_DIR").empty();
    return fmt::format("{}{} ({}){}", chosen ? "POCL_CACHE_DIR=" : "", folder.string(),
        reason.empty() ? "its disk is full, or almost" : reason, chosen || ours.empty() ? "" : ", " + ours);
}

/// The drivers that are registered where loaders look.
std::string registered()
{
    std::string names;
    std::error_code failed;
    for (fs::directory_iterator it(vendors, failed), end; !failed && it != end; it.increment(failed)) {
        if (it->path().extension() == ".icd") {
            names += (names.empty() ? "" : ", ") + it->path().filename().string();
        }
    }
    return names;
}

Error noDriver()
{
    for (const char* variable : { "OCL_ICD_VENDORS", "OCL_ICD_FILENAMES" }) {
        if (const std::string value = valueOf(variable); !value.empty()) {
            return { "OpenCL driver", fmt::format("none found by {}={}", variable, value),
                fmt::format("correct or unset the variable, or {}", install) };
        }
    }
    if (const std::string names = registered(); !names.empty()) {
        return { "OpenCL driver", fmt::format("none found that loads, of {} in {}", names, vendors),
            fmt::format("install their libraries anew, or {}", install) };
    }
    return { "OpenCL driver", "none found", install };
}

} // namespace

std::string whySilent(const std::vector<SilentPlatform>& platforms)
{
    const auto pocl = std::ranges::find_if(
        platforms, [](const SilentPlatform& p) { return p.version.find("PoCL ") != std::string::npos; });
    const std::string refused = pocl == platforms.end() ? "" : refusedFolders();
    return refused.empty() ? ""
                           : fmt::format("{} can write to no folder for what it compiles: {}", pocl->name, refused);
}

Error noDevice(cl_int code, const std::vector<SilentPlatform>& platforms)
{
    if (platforms.empty() && (code == CL_SUCCESS || code == platformNotFound)) {
        return noDriver();
    }
    if (platforms.empty()) {
        return { "OpenCL platforms cannot be listed", fmt::format("{} ({})", clErrorName(code), code),
            "check the OpenCL loader and its drivers" };
    }
    if (const std::string why = whySilent(platforms); !why.empty()) {
        return { "OpenCL device", "none found, since " + why,
            "set POCL_CACHE_DIR to a folder that can be written and has room" };
    }
    std::string all;
    for (const SilentPlatform& p : platforms) {
        all += fmt::format("{}{} ({})", all.empty() ? "" : ", ", p.name, clErrorName(p.code));
    }
    return { "OpenCL device", "none found by the drivers " + all,
        fmt::format("check that they may use one, or {}", install) };
}

} // namespace wedge::device
