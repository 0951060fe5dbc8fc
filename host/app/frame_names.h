#pragma once

#include "host/app/outputs.h"

#include <cstdint>
#include <string>
#include <vector>

namespace wedge::app {

/// Frames of a sequence, both ends among them.
struct FrameRange {
    std::uint32_t first = 0, last = 0;

    std::uint32_t count() const { return last - first + 1; }
};

/// The last number that a frame may have, and how many a call may render.
constexpr std::uint32_t lastFrame = 999999, mostFrames = 100000;

/// "3:10", or "3" for one. Throws UsageError.
FrameRange frameRange(const std::string& option, const std::string& text);

/// The name of a frame's file: the pattern with the number in the place of its one %d or %04d (at least so many
/// digits, 1 to 9), and a % for each %%. Throws UsageError for other patterns.
std::string frameName(const std::string& pattern, std::uint32_t frame);

/// The outputs of a frame, of those with patterns for names.
std::vector<Output> frameOutputs(const std::vector<Output>& patterns, std::uint32_t frame);

} // namespace wedge::app
