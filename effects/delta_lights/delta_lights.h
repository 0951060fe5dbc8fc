#pragma once

#include "host/render/effect.h"

#include <memory>

namespace wedge::render {

/// Direct light of point and directional lights, whose shadows are sharp: one ray each, and no filter.
std::unique_ptr<const Effect> deltaLights();

} // namespace wedge::render
