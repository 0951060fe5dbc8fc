#include "effects/styled_shadows/style_knobs.h"

#include "host/scene/validate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wedge::render {
namespace {

/// Beyond it the transfer function is saturated; and as much again, so that rounding and blur find no end.
constexpr float headroom = 2.0f;
constexpr auto longest = static_cast<float>(scene::maxCoordinate);

shared::StyleKnob knobOf(float constant, float linear, float square, float least, float most)
{
    if (linear == 0.0f && square == 0.0f) {
        const float only = std::clamp(constant, least, most); // between keys of some that vary it may be beyond
        return { only, 0.0f, 0.0f, only, only };
    }
    return { constant, linear, square, least, most };
}

shared::StyleKnob knobOf(const scene::Knob<float>& knob, float least)
{
    return knobOf(knob.constant, knob.linear, knob.square, least, longest);
}

} // namespace

shared::StyleKnob inflationOf(const scene::ShadowStyle& style) { return knobOf(style.inflation, -longest); }
shared::StyleKnob softnessOf(const scene::ShadowStyle& style) { return knobOf(style.softness, 0.0f); }
shared::StyleKnob abstractionOf(const scene::ShadowStyle& style) { return knobOf(style.abstraction, 0.0f); }

shared::StyleKnob brightnessOf(const scene::ShadowStyle& style, int channel)
{
    const scene::Knob<glm::vec3>& knob = style.brightness;
    return knobOf(knob.constant[channel], knob.linear[channel], knob.square[channel], 0.0f, 1.0f);
}

float mostOf(const shared::StyleKnob& knob, float farthest)
{
    const auto at = [&](float d) {
        return std::abs(std::clamp(knob.base + d * (knob.linear + d * knob.square), knob.least, knob.most));
    };
    const float most = std::max(at(0.0f), at(farthest));
    const float turn = knob.square != 0.0f ? -0.5f * knob.linear / knob.square : 0.0f;
    return turn > 0.0f && turn < farthest ? std::max(most, at(turn)) : most;
}

bool variesByOccluder(const scene::ShadowStyle& style)
{
    return style.inflation.varies() || style.softness.varies() || style.abstraction.varies()
        || style.brightness.varies() || std::ranges::any_of(style.keys, variesByOccluder);
}

float farthestOccluder(const scene::Scene& scene, std::uint32_t index)
{
    const scene::Bounds bounds = scene::sceneBounds(scene);
    if (bounds.empty()) {
        return 1.0f;
    }
    const glm::dvec3 lo(bounds.lo), hi(bounds.hi);
    double most = glm::length(hi - lo);
    if (index < scene.pointLights.size()) {
        const glm::dvec3 at(scene.pointLights[index].position);
        most = std::min(most, glm::length(glm::max(glm::abs(lo - at), glm::abs(hi - at))));
    } else {
        // The longest way through the box.
        const glm::dvec3 along(glm::abs(scene.directionalLights[index - scene.pointLights.size()].direction));
        for (int axis = 0; axis < 3; ++axis) {
            most = along[axis] > 0.0 ? std::min(most, (hi[axis] - lo[axis]) / along[axis]) : most;
        }
    }
    return std::max(static_cast<float>(most), std::numeric_limits<float>::min());
}

namespace {

/// Metres from a shadow's edge beyond which a style's transfer function is saturated, and that its blur reaches.
float saturatedFrom(const scene::ShadowStyle& style, float farthest)
{
    return mostOf(inflationOf(style), farthest) + 0.5f * mostOf(softnessOf(style), farthest)
        + WEDGE_STYLE_CUT * mostOf(abstractionOf(style), farthest);
}

} // namespace

float mostDistance(std::span<const scene::ShadowStyle> styles, float farthest)
{
    float most = 0.0f;
    for (const scene::ShadowStyle& style : styles) {
        // What lies between two keys is no more than at one of them.
        if (style.keys.empty()) {
            most = std::max(most, saturatedFrom(style, farthest));
        }
        for (const scene::ShadowStyle& key : style.keys) {
            most = std::max(most, saturatedFrom(key, farthest));
        }
    }
    return headroom * most;
}

} // namespace wedge::render
