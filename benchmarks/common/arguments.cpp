#include "benchmarks/common/arguments.h"

#include "host/error.h"
#include "host/scene/scene.h"

#include <charconv>

#include <fmt/format.h>

namespace wedge::benchmark {

void setSize(MeasurePlan& plan, const std::string& text)
{
    const char* end = text.data() + text.size();
    const auto width = std::from_chars(text.data(), end, plan.width);
    const bool split = width.ec == std::errc() && width.ptr != end && *width.ptr == 'x';
    const auto height = std::from_chars(split ? width.ptr + 1 : end, end, plan.height);
    if (!split || height.ec != std::errc() || height.ptr != end || plan.width < 8 || plan.height < 8
        || plan.width > scene::maxImageSide || plan.height > scene::maxImageSide) {
        throw UsageError("--size", text, fmt::format("give WIDTHxHEIGHT, each from 8 to {}", scene::maxImageSide));
    }
}

} // namespace wedge::benchmark
