#include "effects/environment/map_numbers.h"

#include "host/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

namespace wedge::render {
namespace {

constexpr const char* kind = "environment maps";

struct Numbers {
    std::size_t wrong = 0; ///< NaN or minus infinity
    std::size_t negative = 0;
    float largest = 0.0f, lowest = 0.0f; ///< of the finite ones and 0
    double above = 0.0, below = 0.0; ///< sums of the finite ones above 0 and below
};

Numbers numbersOf(const image::RgbImage& map)
{
    Numbers n;
    for (const float c : map.rgb) {
        if (std::isnan(c) || c == -std::numeric_limits<float>::infinity()) {
            ++n.wrong;
        } else if (std::isfinite(c)) {
            n.largest = std::max(n.largest, c);
            n.lowest = std::min(n.lowest, c);
            n.negative += c < 0.0f ? 1 : 0;
            (c < 0.0f ? n.below : n.above) += c;
        }
    }
    return n;
}

std::string counted(std::size_t texels) { return fmt::format("{} {}", texels, texels == 1 ? "texel" : "texels"); }

/// How many texels have a number above `limit`, which become that.
std::size_t limitTo(image::RgbImage& map, float limit)
{
    std::size_t texels = 0;
    for (std::size_t i = 0; i + 2 < map.rgb.size(); i += 3) {
        bool isAbove = false;
        for (std::size_t c = i; c < i + 3; ++c) {
            isAbove |= map.rgb[c] > limit;
            map.rgb[c] = std::min(map.rgb[c], limit);
        }
        texels += isAbove ? 1 : 0;
    }
    return texels;
}

void limitInfinite(image::RgbImage& map, const Numbers& numbers, const std::string& path, scene::Warnings& warnings)
{
    const auto infinite = std::ranges::count_if(map.rgb, [](float c) { return std::isinf(c); });
    if (infinite == 0) {
        return;
    }
    if (!(numbers.largest > 0.0f)) {
        throw Error("environment map has infinite numbers and no finite one above 0",
            fmt::format("{} in {}", infinite, path), "repair the map, or write it anew");
    }
    const std::size_t texels = limitTo(map, numbers.largest);
    warnings.add(kind,
        fmt::format(
            "environment map {}: {} as {:g}, the largest finite number in it: repair the map, or write it anew as "
            "32-bit floats",
            path, counted(texels) + (texels == 1 ? " is infinite, and counts" : " are infinite, and count"),
            numbers.largest));
}

/// Resampling overshoots by a fifth of an edge at most, and beside few texels.
void warnOfNegative(const Numbers& numbers, const std::string& path, scene::Warnings& warnings)
{
    constexpr double ofLargest = 0.25, ofSum = 0.01;
    if (-numbers.lowest > ofLargest * numbers.largest || -numbers.below > ofSum * numbers.above) {
        warnings.add(kind,
            fmt::format("environment map {}: {} negative numbers, down to {:g}, are no radiance and count as 0: repair "
                        "the map, or write it anew",
                path, numbers.negative, numbers.lowest));
    }
}

} // namespace

void makeRadiances(image::RgbImage& map, float intensity, const std::string& path, scene::Warnings& warnings)
{
    const Numbers numbers = numbersOf(map);
    if (numbers.wrong > 0) {
        throw Error("environment map has numbers that are no radiance", fmt::format("{} in {}", numbers.wrong, path),
            "repair the map, or write it anew");
    }
    limitInfinite(map, numbers, path, warnings);
    warnOfNegative(numbers, path, warnings);
    for (float& c : map.rgb) {
        c = std::max(c * intensity, 0.0f);
    }
    if (const std::size_t texels = limitTo(map, mostRadiance); texels > 0) {
        warnings.add(kind,
            fmt::format(
                "environment map {}: {} beyond {:g} W/(sr m^2) by its numbers and the intensity {:g}, and count "
                "as that: lower the intensity, or repair the map",
                path, counted(texels) + (texels == 1 ? " is" : " are"), mostRadiance, intensity));
    }
}

} // namespace wedge::render
