#include "host/app/frame_names.h"

#include "host/app/values.h"
#include "host/error.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace wedge::app {
namespace {

/// What stands for the number from `at` on, behind a %: its digits, and where it ends.
struct Place {
    int digits = 1;
    std::size_t end = 0; ///< 0: it is none
};

Place placeAt(const std::string& pattern, std::size_t at)
{
    const auto is = [&](std::size_t i, char c) { return i < pattern.size() && pattern[i] == c; };
    if (is(at, 'd')) {
        return { 1, at + 1 };
    }
    if (is(at, '0') && at + 1 < pattern.size() && pattern[at + 1] >= '1' && pattern[at + 1] <= '9' && is(at + 2, 'd')) {
        return { pattern[at + 1] - '0', at + 3 };
    }
    return {};
}

[[noreturn]] void fail(const std::string& what, const std::string& pattern)
{
    throw UsageError(what, pattern, "name frames like shot.%04d.exr, and write %% for a %");
}

} // namespace

FrameRange frameRange(const std::string& option, const std::string& text)
{
    const std::size_t colon = text.find(':');
    const auto number = [&](const std::string& part) {
        if (part.empty() || !std::ranges::all_of(part, [](unsigned char c) { return std::isdigit(c) != 0; })) {
            throw UsageError(option, text.empty() ? "(empty)" : text, "give FIRST:LAST, like 0:99, or one number");
        }
        return static_cast<std::uint32_t>(wholeNumber(option, part, 0, lastFrame));
    };
    const std::uint32_t first = number(text.substr(0, colon));
    const FrameRange range { first, colon == std::string::npos ? first : number(text.substr(colon + 1)) };
    if (range.last < range.first) {
        throw UsageError(option + " ends before it begins", text, "give the first frame first");
    }
    if (range.count() > mostFrames) {
        throw UsageError(
            option + " has too many frames for one call", text, fmt::format("give at most {}", mostFrames));
    }
    return range;
}

std::string frameName(const std::string& pattern, std::uint32_t frame)
{
    std::string name;
    bool numbered = false;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%') {
            name += pattern[i];
            continue;
        }
        if (i + 1 < pattern.size() && pattern[i + 1] == '%') {
            name += pattern[++i];
            continue;
        }
        const Place place = placeAt(pattern, i + 1);
        if (place.end == 0) {
            fail("output's % is followed by no frame number", pattern);
        }
        if (numbered) {
            fail("output has more than one frame number", pattern);
        }
        numbered = true;
        name += fmt::format("{:0{}}", frame, place.digits);
        i = place.end - 1;
    }
    if (!numbered) {
        fail("output of a sequence has no frame number", pattern);
    }
    return name;
}

std::vector<Output> frameOutputs(const std::vector<Output>& patterns, std::uint32_t frame)
{
    std::vector<Output> outputs = patterns;
    for (Output& output : outputs) {
        output.path = frameName(output.path, frame);
    }
    return outputs;
}

} // namespace wedge::app
