#pragma once

#include "host/render/effect.h"

#include <memory>

namespace wedge::render {

/// Direct light of the point and directional lights whose hard shadows are drawn in a style: moved outwards or inwards,
/// softened, smoothed, brightened or coloured. docs/stylized-shadows.md
std::unique_ptr<const Effect> styledShadows();

} // namespace wedge::render
