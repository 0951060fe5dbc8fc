#pragma once

#include "host/device/limits.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace wedge::device {

/// The buffers of a frame, added up before any is allocated. All sums and products saturate at 2^64 - 1 in place of
/// wrapping, so that an absurd image is refused and never looks small.
class MemoryPlan {
public:
    /// One buffer of that many bytes.
    void add(std::string name, std::uint64_t bytes);
    /// One buffer of count elements.
    void addItems(std::string name, std::uint64_t count, std::uint64_t bytesEach);

    /// What users may do besides a smaller image and another device: "take fewer samples with --spp".
    void otherWayOut(std::string way) { otherWayOut_ = std::move(way); }

    /// Bytes of all buffers.
    std::uint64_t total() const;

    /// A line a buffer, largest first, and the total, in MiB; ends with a newline.
    std::string table() const;

    /// Throws Error if a buffer exceeds what the device allocates at once, or all of them the smaller of
    /// userLimitBytes (0: no limit of the user's) and the device's memory less a reserve: 1/10, or 1/5 where the
    /// memory is the host's too. The message has the total, the largest buffer, the limit and the way out.
    void check(const DeviceInfo& device, std::uint64_t userLimitBytes = 0) const;

    /// Whether check() throws nothing.
    bool fits(const DeviceInfo& device, std::uint64_t userLimitBytes = 0) const;

private:
    struct Part {
        std::string name;
        std::uint64_t bytes;
    };
    const Part& largest() const;

    std::vector<Part> parts_;
    std::string otherWayOut_;
};

/// "12.3 MiB", for messages.
std::string mebibytes(std::uint64_t bytes);

} // namespace wedge::device
