#pragma once

#include "host/render/effect.h"

#include <memory>

namespace wedge::render {

/// Soft shadows: direct light of area lights, thesis chapter 3, docs/soft-shadows.md. One term a light.
std::unique_ptr<const Effect> areaLights();

} // namespace wedge::render
