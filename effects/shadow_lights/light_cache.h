#pragma once

#include "effects/shadow_lights/whole_light.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wedge::render {

/// Most exponents of a kind of lobe that have tables of their own.
inline constexpr std::size_t mostCachedExponents = 16;

/// Lobes that there are tables of, packGloss() of each: by kinds, of each from the smallest exponent to the largest; of
/// microfacets each exponent twice, of Gloss::rise 0 and WEDGE_CACHE_RISE. All of a scene's where it has at most
/// mostCachedExponents of a kind; else as many, evenly spaced by the logarithm of 1 + the exponent.
std::vector<std::uint32_t> cachedGlosses(const scene::Scene& scene);

/// Declares the passes that find a map's whole light by pixels' normals (kernels/light/light_cache.cl).
WholeLights cachedLights(FrameBuilder& frame);

} // namespace wedge::render
