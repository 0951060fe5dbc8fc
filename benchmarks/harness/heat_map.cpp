#include "benchmarks/harness/heat_map.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace wedge::benchmark {
namespace {

// Of a display: lightness rises all the way, so that the map can be read without its colours too.
constexpr std::array<std::array<double, 3>, 6> ramp { { { 0.0, 0.0, 0.0 }, { 0.15, 0.1, 0.55 }, { 0.6, 0.1, 0.5 },
    { 0.93, 0.35, 0.15 }, { 1.0, 0.8, 0.2 }, { 1.0, 1.0, 1.0 } } };

double linear(double display)
{
    return display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4);
}

} // namespace

image::RgbImage heatMap(
    const std::vector<float>& values, int width, int height, double low, double high, bool logarithmic)
{
    assert(values.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    assert(!logarithmic || low > 0);
    const auto scale = [&](double v) { return logarithmic ? std::log(std::max(v, low)) : v; };
    const double from = scale(low), range = std::max(1e-12, scale(high) - from);
    image::RgbImage out { width, height, {} };
    out.rgb.reserve(3 * values.size());
    for (const float value : values) {
        const double at = std::clamp((scale(value) - from) / range, 0.0, 1.0) * (ramp.size() - 1);
        const auto piece = std::min(static_cast<std::size_t>(at), ramp.size() - 2);
        for (std::size_t c = 0; c < 3; ++c) {
            out.rgb.push_back(static_cast<float>(
                linear(std::lerp(ramp[piece][c], ramp[piece + 1][c], at - static_cast<double>(piece)))));
        }
    }
    return out;
}

} // namespace wedge::benchmark
