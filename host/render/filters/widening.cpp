#include "host/render/filters/widening.h"

#include <algorithm>
#include <cmath>

namespace wedge::render {

int comparedReach(const Settings& settings, float pixels)
{
    return std::min(settings.maxRadius, static_cast<int>(std::ceil(settings.cut * pixels)));
}

bool widens(const Settings& s)
{
    return s.widening > 0 && s.method == Method::AxisAligned && s.filtering == Filtering::Adaptive && !s.published
        && s.shading == Shading::Ratio;
}

} // namespace wedge::render
