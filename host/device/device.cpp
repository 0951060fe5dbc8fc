#include "host/device/device.h"

#include "host/device/cache_root.h"
#include "host/device/cl_error.h"
#include "host/device/driver_cache.h"
#include "host/device/no_device.h"
#include "host/device/quirks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <functional>
#include <optional>

namespace wedge::device {
namespace {

struct Candidate {
    DeviceInfo info;
    cl::Device device;
};

/// What there is.
struct Found {
    std::vector<Candidate> all;
    std::vector<SilentPlatform> silent;
    cl_int code = CL_SUCCESS; ///< of the loader
};

std::vector<cl::Platform> platforms(cl_int& code)
{
    DriverCache::ofProcess(); // before the driver asks where its cache is
    std::vector<cl::Platform> found;
    try {
        cl::Platform::get(&found);
    } catch (const cl::Error& error) {
        found.clear(); // the loader reports "no platform" as an error
        code = error.err();
    }
    return found;
}

/// A platform without devices is an error to OpenCL, and a broken one must not hide the others.
SilentPlatform silent(const cl::Platform& platform, cl_int code)
{
    try {
        return { trimmed(platform.getInfo<CL_PLATFORM_NAME>()), trimmed(platform.getInfo<CL_PLATFORM_VERSION>()),
            code };
    } catch (const cl::Error& error) {
        return { "without a name", "", error.err() };
    }
}

Found search()
{
    Found found;
    for (const cl::Platform& platform : platforms(found.code)) {
        std::vector<cl::Device> devices;
        cl_int code = CL_DEVICE_NOT_FOUND;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error& error) {
            devices.clear();
            code = error.err();
        }
        if (devices.empty()) {
            found.silent.push_back(silent(platform, code));
        }
        for (const cl::Device& device : devices) {
            found.all.push_back({ queryDevice(platform, device, static_cast<unsigned>(found.all.size())), device });
        }
    }
    return found;
}

std::string lowered(std::string text)
{
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

using Test = std::function<bool(const DeviceInfo&)>;

Test isOfType(DeviceType type)
{
    return [type](const DeviceInfo& info) { return info.type == type; };
}

std::optional<Candidate> firstUsable(const std::vector<Candidate>& all, const Test& test)
{
    for (const Candidate& candidate : all) {
        if (candidate.info.unusable.empty() && test(candidate.info)) {
            return candidate;
        }
    }
    return std::nullopt;
}

/// The first test that any device meets decides.
std::optional<Candidate> firstUsable(const std::vector<Candidate>& all, const std::vector<Test>& preferences)
{
    for (const Test& test : preferences) {
        if (auto found = firstUsable(all, test)) {
            return found;
        }
    }
    return std::nullopt;
}

std::optional<Candidate> select(const std::vector<Candidate>& all, const std::string& selector)
{
    if (selector.empty()) {
        return firstUsable(all,
            std::vector<Test> {
                isOfType(DeviceType::Gpu), isOfType(DeviceType::Cpu), [](const auto&) { return true; } });
    }
    const std::string wanted = lowered(selector);
    if (wanted.find_first_not_of(" \t") == std::string::npos) {
        return std::nullopt; // a part of many a name, and nobody's choice
    }
    if (wanted == "cpu" || wanted == "gpu") {
        return firstUsable(all, isOfType(wanted == "cpu" ? DeviceType::Cpu : DeviceType::Gpu));
    }
    std::size_t index = 0;
    const char* end = wanted.data() + wanted.size();
    if (const auto [stop, status] = std::from_chars(wanted.data(), end, index); stop == end) {
        return status == std::errc() && index < all.size() ? std::optional(all[index]) : std::nullopt;
    }
    const auto holds = [wanted](const std::string& text) { return lowered(text).find(wanted) != std::string::npos; };
    return firstUsable(all,
        std::vector<Test> { [holds](const DeviceInfo& info) { return holds(info.name); },
            [holds](const DeviceInfo& info) { return holds(info.platform); } });
}

std::string described(const std::vector<Candidate>& all)
{
    std::string text;
    for (const Candidate& candidate : all) {
        const DeviceInfo& info = candidate.info;
        text += fmt::format("{}{} = {} ({}{})", text.empty() ? "" : ", ", info.index, info.name,
            deviceTypeName(info.type), info.unusable.empty() ? "" : ", unusable: " + info.unusable);
    }
    return text;
}

} // namespace

std::vector<DeviceInfo> listDevices()
{
    std::vector<DeviceInfo> infos;
    for (Candidate& candidate : search().all) {
        infos.push_back(std::move(candidate.info));
    }
    return infos;
}

void requireDevices()
{
    if (const Found found = search(); found.all.empty()) {
        throw noDevice(found.code, found.silent);
    }
}

std::vector<std::string> deviceNotices()
{
    const Found found = search();
    const CacheRoot& root = CacheRoot::ofProcess();
    std::vector<std::string> lines = { root.notice, DriverCache::ofProcess().notice() };
    if (!found.all.empty()) {
        lines.push_back(
            root.failure.empty() ? "" : "compiled kernels are not kept, for want of a folder: " + root.failure);
        lines.push_back(whySilent(found.silent));
    }
    std::erase(lines, "");
    return lines;
}

Device Device::open(const std::string& selector)
{
    const Found found = search();
    const std::vector<Candidate>& all = found.all;
    if (all.empty()) {
        throw noDevice(found.code, found.silent);
    }
    if (!firstUsable(all, [](const DeviceInfo&) { return true; })) {
        throw Error("OpenCL device that can be used", "none of " + described(all),
            "install another OpenCL driver, or all of this one");
    }
    std::optional<Candidate> chosen = select(all, selector);
    if (!chosen) {
        const std::string silent = whySilent(found.silent);
        throw Error("no such OpenCL device", selector,
            "choose cpu, gpu, an index or part of a name of: " + described(all)
                + (silent.empty() ? "" : "; " + silent));
    }
    if (!chosen->info.unusable.empty()) {
        throw Error(
            "OpenCL device " + chosen->info.name, chosen->info.unusable, "choose another of: " + described(all));
    }
    return Device(std::move(chosen->info), std::move(chosen->device));
}

Device::Device(DeviceInfo info, cl::Device device)
    : info_(std::move(info))
    , device_(std::move(device))
{
    checked("opening the device", info_.name, [this] {
        context_ = cl::Context(device_);
        info_.hostTimers = probeHostTimers(context_, device_);
        info_.quirks = applyQuirks(info_);
    });
}

} // namespace wedge::device
