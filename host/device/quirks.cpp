#include "host/device/quirks.h"

#include <charconv>
#include <cstdlib>
#include <limits>
#include <optional>

#include <fmt/format.h>

namespace wedge::device {
namespace {

constexpr const char* workGroupMethod = "POCL_WORK_GROUP_METHOD"; // read whenever PoCL compiles a kernel
constexpr const char* continuations = "cbs";
constexpr const char* kernelCache = "POCL_KERNEL_CACHE"; // not 1: PoCL forgets

/// The whole number behind a word: 18 of "... LLVM 18.1.8 ..." and "LLVM ".
std::optional<int> numberBehind(std::string_view text, std::string_view word)
{
    const std::size_t at = text.find(word);
    if (at == std::string_view::npos) {
        return std::nullopt;
    }
    const std::string_view rest = text.substr(at + word.size());
    int number = 0;
    const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), number);
    return status == std::errc() ? std::optional(number) : std::nullopt;
}

} // namespace

bool poclFailsToCompile(std::string_view platformVersion)
{
    const std::optional<int> pocl = numberBehind(platformVersion, "PoCL ");
    const std::optional<int> llvm = numberBehind(platformVersion, "LLVM ");
    return pocl && llvm && *pocl < 7 && *llvm >= 18;
}

bool driverKeepsKernels(std::string_view platformVersion)
{
    const char* setting = std::getenv(kernelCache);
    return numberBehind(platformVersion, "PoCL ").has_value() && (setting == nullptr || *setting == '1');
}

bool driverFailsWithParts(std::string_view platformVersion)
{
    return platformVersion.find("CUDA") != std::string_view::npos;
}

std::vector<std::string> applyQuirks(const DeviceInfo& info)
{
    std::vector<std::string> inForce;
    if (poclFailsToCompile(info.platformVersion)) {
        ::setenv(workGroupMethod, continuations, 0);
        const char* method = std::getenv(workGroupMethod);
        if (method == nullptr || std::string_view(method) == continuations) {
            inForce.push_back(fmt::format("{}={}: this version ends the process while it compiles by its other methods",
                workGroupMethod, continuations));
        } else {
            inForce.push_back(
                fmt::format("{}={} is set: this version may end the process while it compiles, {} does not",
                    workGroupMethod, method, continuations));
        }
    }
    if (driverKeepsKernels(info.platformVersion)) {
        inForce.emplace_back("programs come from the driver's own cache: binaries would be compiled anew for it");
    }
    if (info.failsWithParts) {
        inForce.emplace_back("planes take turns in whole buffers: the driver ends the process over parts that overlap");
    }
    if (info.hostTimers) {
        inForce.emplace_back("passes are timed by the host's clock: the driver's times are none");
    }
    if (info.type == DeviceType::Cpu) {
        inForce.push_back(
            fmt::format("launches of at most {} items: drivers for CPUs may compile once more for larger ones",
                info.maxTiledItems));
    }
    return inForce;
}

} // namespace wedge::device
