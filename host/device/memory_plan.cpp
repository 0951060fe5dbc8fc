#include "host/device/memory_plan.h"

#include "host/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace wedge::device {
namespace {

constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
constexpr const char* wayOut = "render a smaller image with --size, or choose a device with more memory with --device";

std::uint64_t saturatingAdd(std::uint64_t a, std::uint64_t b) { return b > most - a ? most : a + b; }
std::uint64_t saturatingMul(std::uint64_t a, std::uint64_t b) { return b != 0 && a > most / b ? most : a * b; }

/// Of all buffers together.
struct Limit {
    std::uint64_t bytes;
    bool isUsers; ///< else the device's
};

Limit limitOf(const DeviceInfo& device, std::uint64_t userLimitBytes)
{
    const std::uint64_t reserve = device.globalMemory / (device.unifiedMemory ? 5 : 10);
    const std::uint64_t ofDevice = device.globalMemory - reserve;
    const bool isUsers = userLimitBytes != 0 && userLimitBytes < ofDevice;
    return { isUsers ? userLimitBytes : ofDevice, isUsers };
}

} // namespace

std::string mebibytes(std::uint64_t bytes)
{
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024.0 * 1024.0));
}

void MemoryPlan::add(std::string name, std::uint64_t bytes) { parts_.push_back({ std::move(name), bytes }); }

void MemoryPlan::addItems(std::string name, std::uint64_t count, std::uint64_t bytesEach)
{
    add(std::move(name), saturatingMul(count, bytesEach));
}

std::uint64_t MemoryPlan::total() const
{
    std::uint64_t sum = 0;
    for (const Part& part : parts_) {
        sum = saturatingAdd(sum, part.bytes);
    }
    return sum;
}

std::string MemoryPlan::table() const
{
    std::vector<Part> sorted = parts_;
    std::stable_sort(sorted.begin(), sorted.end(), [](const Part& a, const Part& b) { return a.bytes > b.bytes; });
    sorted.push_back({ "total", total() });
    std::size_t width = 0;
    for (const Part& part : sorted) {
        width = std::max(width, part.name.size());
    }
    std::string text;
    for (const Part& part : sorted) {
        text += fmt::format("{:<{}}  {:>12}\n", part.name, width, mebibytes(part.bytes));
    }
    return text;
}

const MemoryPlan::Part& MemoryPlan::largest() const
{
    return *std::max_element(
        parts_.begin(), parts_.end(), [](const Part& a, const Part& b) { return a.bytes < b.bytes; });
}

bool MemoryPlan::fits(const DeviceInfo& device, std::uint64_t userLimitBytes) const
{
    return parts_.empty()
        || (total() <= limitOf(device, userLimitBytes).bytes && largest().bytes <= device.maxAllocation);
}

void MemoryPlan::check(const DeviceInfo& device, std::uint64_t userLimitBytes) const
{
    if (parts_.empty()) {
        return;
    }
    const Part& part = largest();
    const auto [limit, limitedByUser] = limitOf(device, userLimitBytes);
    const std::string remedy = otherWayOut_.empty() ? wayOut : fmt::format("{}, {}", otherWayOut_, wayOut);
    const std::string needed =
        fmt::format("{}, the most of it for {} ({})", mebibytes(total()), part.name, mebibytes(part.bytes));
    if (total() > limit) {
        throw Error(fmt::format("memory needed on {} exceeds the {} {}", device.name, mebibytes(limit),
                        limitedByUser ? "that are allowed" : "that it has to give"),
            needed, remedy);
    }
    if (part.bytes > device.maxAllocation) {
        throw Error(fmt::format("memory needed on {} has a buffer above its limit of {}", device.name,
                        mebibytes(device.maxAllocation)),
            needed, remedy);
    }
}

} // namespace wedge::device
