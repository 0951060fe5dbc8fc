#include "effects/environment/angular_map.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace wedge::render {
namespace {

constexpr int mostRows = 2048;

/// Between the four texels around a place, which is in texels from the upper left corner.
void addTexel(const image::RgbImage& image, double x, double y, float* out)
{
    const auto within = [](double v, int size) { return std::clamp(static_cast<int>(v), 0, size - 1); };
    const double fx = std::floor(x - 0.5), fy = std::floor(y - 0.5);
    for (int corner = 0; corner < 4; ++corner) {
        const int right = corner % 2, below = corner / 2;
        const double tx = x - 0.5 - fx, ty = y - 0.5 - fy;
        const double weight = (right != 0 ? tx : 1 - tx) * (below != 0 ? ty : 1 - ty);
        const auto at =
            static_cast<std::size_t>(within(fy + below, image.height)) * static_cast<std::size_t>(image.width)
            + static_cast<std::size_t>(within(fx + right, image.width));
        for (std::size_t c = 0; c < 3; ++c) {
            out[c] += static_cast<float>(weight * image.rgb[3 * at + c]);
        }
    }
}

} // namespace

image::RgbImage latLongOfAngular(const image::RgbImage& angular)
{
    assert(angular.width == angular.height);
    const int height = std::clamp(angular.height, 1, mostRows), width = 2 * height;
    image::RgbImage out { width, height, {} };
    out.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const double pi = std::acos(-1.0), side = angular.width;
    for (int y = 0; y < height; ++y) {
        const double elevation = pi * (0.5 - (y + 0.5) / height);
        for (int x = 0; x < width; ++x) {
            const double azimuth = 2 * pi * ((x + 0.5) / width - 0.5);
            const double right = std::sin(azimuth) * std::cos(elevation), up = std::sin(elevation),
                         ahead = std::cos(azimuth) * std::cos(elevation), aside = std::hypot(right, up);
            const double radius = std::atan2(aside, ahead) / pi, scale = aside > 0 ? radius / aside : 0.0;
            addTexel(angular, 0.5 * side * (1 + right * scale), 0.5 * side * (1 - up * scale),
                &out.rgb[3
                    * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))]);
        }
    }
    return out;
}

} // namespace wedge::render
