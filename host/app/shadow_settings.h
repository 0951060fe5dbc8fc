#pragma once

#include "host/app/render_options.h"
#include "host/render/prepared_scene.h"
#include "host/render/renderer.h"
#include "host/render/settings.h"

#include <string>

namespace wedge::app {

/// Lights that stand for a map, and what goes with them alone. Throws UsageError for options that have no effect.
void applyShadows(const RenderOptions& options, const render::PreparedScene& scene, render::Settings& settings);

/// Throws UsageError for any of these options, as having no effect with something.
void refuseShadows(const RenderOptions& options, const std::string& with, const std::string& remedy);

/// Pixels along each side of the blocks of which one traces rays, as --shadow-scale has them.
inline constexpr int shadowBlockSides[] = { 1, 2, 4, 32 };

/// Chooses how many lights there are, and which share of the pixels traces rays to them, so that a frame takes about so
/// many seconds of device time: as many lights as the default has, of as many pixels as there is time for; else more of
/// them. It goes by a + b N r, of N lights and the share r, fitted to frames of 1/64 of the pixels, which are rendered.
/// Warns where even the least takes longer. Returns what was chosen, for the user. settings: with lights that stand for
/// a map
std::string chooseShadows(render::Renderer& renderer, double seconds, render::Settings& settings);

} // namespace wedge::app
