#pragma once

#include "host/image/image.h"

#include <vector>

namespace wedge::benchmark {

/// Values as colours, linear: black at or below `low` through blue, red and yellow to white at or above `high`.
/// logarithmic: equal ratios are equal steps; low must then be above 0.
image::RgbImage heatMap(
    const std::vector<float>& values, int width, int height, double low, double high, bool logarithmic);

} // namespace wedge::benchmark
