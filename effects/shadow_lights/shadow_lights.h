#pragma once

#include "host/render/effect.h"

#include <memory>

namespace wedge::render {

/// Direct light from beyond the scene by directional lights that stand for its map, each with a shadow ray; unfiltered,
/// in the place of the environment's terms where ShadowSettings ask for it, docs/shadow-lights.md.
std::unique_ptr<const Effect> shadowLights();

} // namespace wedge::render
