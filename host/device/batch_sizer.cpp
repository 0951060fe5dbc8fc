#include "host/device/batch_sizer.h"

#include <algorithm>

namespace wedge::device {
namespace {

constexpr std::size_t maxGrowth = 8;

} // namespace

BatchSizer::BatchSizer(
    double targetMilliseconds, std::size_t limit, std::size_t firstGroups, double millisecondsPerGroup)
    : target_(targetMilliseconds)
    , limit_(std::max<std::size_t>(limit, 1))
    , millisecondsPerGroup_(millisecondsPerGroup)
    // A pass seen before starts at half its target: the camera may have turned to something dearer since.
    , groups_(known() ? groupsFor(target_ / 2.0) : std::clamp<std::size_t>(firstGroups, 1, limit_))
{
}

std::size_t BatchSizer::groupsFor(double milliseconds) const
{
    const double wanted = milliseconds / std::max(millisecondsPerGroup_, 1e-9);
    return wanted >= static_cast<double>(limit_) ? limit_ : std::max<std::size_t>(1, static_cast<std::size_t>(wanted));
}

void BatchSizer::measured(std::size_t groups, double milliseconds)
{
    millisecondsPerGroup_ = std::max(milliseconds, 0.0) / static_cast<double>(std::max<std::size_t>(groups, 1));
    groups_ = std::min(groupsFor(target_), groups * maxGrowth);
}

} // namespace wedge::device
