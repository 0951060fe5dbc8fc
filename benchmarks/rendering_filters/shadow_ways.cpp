#include "benchmarks/rendering_filters/shadow_ways.h"

#include "host/error.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace wedge::benchmark {

using render::Shadows;
using render::ShadowSettings;

const std::vector<ShadowWay>& shadowWays()
{
    static const std::vector<ShadowWay> all {
        { additiveWay, [](ShadowSettings& s) { s.shadows = Shadows::Additive; } },
        { subtractiveWay, [](ShadowSettings& s) { s.shadows = Shadows::Subtractive; } },
        { "subtractive, not clamped",
            [](ShadowSettings& s) {
                s.shadows = Shadows::Subtractive;
                s.clamp = false;
            } },
        { ratioWay, [](ShadowSettings& s) { s.shadows = Shadows::Ratio; } },
        { "subtractive, 8 a pixel",
            [](ShadowSettings& s) {
                s.shadows = Shadows::Subtractive;
                s.chosen = 8;
            } },
        { chosenWay,
            [](ShadowSettings& s) {
                s.shadows = Shadows::Ratio;
                s.chosen = 8;
            } },
        { "ratio, table of normals",
            [](ShadowSettings& s) {
                s.shadows = Shadows::Ratio;
                s.whole = render::WholeLight::Cache;
            } },
        { "ratio, 1/4 of pixels",
            [](ShadowSettings& s) {
                s.shadows = Shadows::Ratio;
                s.blockSide = 2;
            } },
        { "ratio, 1/16 of pixels",
            [](ShadowSettings& s) {
                s.shadows = Shadows::Ratio;
                s.blockSide = 4;
            } },
        { "ratio, 1/1024 of pixels",
            [](ShadowSettings& s) {
                s.shadows = Shadows::Ratio;
                s.blockSide = 32;
            } },
    };
    return all;
}

std::vector<ShadowWay> shadowWays(const std::vector<std::string>& names)
{
    const std::vector<ShadowWay>& all = shadowWays();
    for (const std::string& name : names) {
        if (std::ranges::find(all, name, &ShadowWay::name) == all.end()) {
            std::vector<std::string> known(all.size());
            std::ranges::transform(all, known.begin(), &ShadowWay::name);
            throw UsageError(
                "way of shadows", "--way " + name, fmt::format("choose among: {}", fmt::join(known, "; ")));
        }
    }
    std::vector<ShadowWay> out;
    std::ranges::copy_if(all, std::back_inserter(out),
        [&](const ShadowWay& way) { return names.empty() || std::ranges::find(names, way.name) != names.end(); });
    return out;
}

} // namespace wedge::benchmark
