#pragma once

#include "host/graph/graph.h"
#include "host/scene/scene.h"
#include "kernels/shared/styled_shadows.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace wedge::graph {

template <>
inline constexpr std::string_view kernelType<shared::StyleKnob> = "StyleKnob";

} // namespace wedge::graph

namespace wedge::render {

/// A style's knobs as kernels take them, within their ranges.
shared::StyleKnob inflationOf(const scene::ShadowStyle& style);
shared::StyleKnob softnessOf(const scene::ShadowStyle& style);
shared::StyleKnob abstractionOf(const scene::ShadowStyle& style);
/// Of the channel 0, 1 or 2.
shared::StyleKnob brightnessOf(const scene::ShadowStyle& style, int channel);

/// A number of a style, which style() finds in the scene: of one with keys the same pass finds another one later.
template <class Style, class Number>
graph::Argument knobValue(std::string name, const Style& style, const Number& number)
{
    const auto now = [style, number] { return number(style()); };
    return style().keys.empty() ? graph::value(std::move(name), now()) : graph::changing(std::move(name), now);
}

/// The largest that a knob has, either way, for what is up to so many metres away.
float mostOf(const shared::StyleKnob& knob, float farthest);

/// Whether a style goes by how far away what hides the light is, or does at one of its keys.
bool variesByOccluder(const scene::ShadowStyle& style);

/// Metres that nothing is farther away than, of what hides a light from what it lights: a directional one, or a point
/// light. At least the least above 0. index: among point lights and then directional ones.
float farthestOccluder(const scene::Scene& scene, std::uint32_t index);

/// Metres from a shadow's edge beyond which no style tells distances apart, at least 0: twice |inflation| +
/// softness / 2 + 3 abstraction, of the style that has most, of what is up to `farthest` metres away; of one with keys,
/// at the key that has most.
float mostDistance(std::span<const scene::ShadowStyle> styles, float farthest);

} // namespace wedge::render
