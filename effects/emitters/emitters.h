#pragma once

#include "host/render/effect.h"

#include <memory>

namespace wedge::render {

/// Direct light of the meshes that emit, and of the quads, that have no term of their own, docs/emitters.md: a diffuse
/// term, and, where something is specular, a glossy one.
std::unique_ptr<const Effect> emitters();

} // namespace wedge::render
