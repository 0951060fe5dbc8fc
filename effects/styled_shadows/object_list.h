#pragma once

#include "effects/styled_shadows/styled_lights.h"
#include "host/render/frame_builder.h"

#include <string>
#include <vector>

namespace wedge::render {

/// A list, by that name, of 1 or 0 for each object's id and for 0: whether it goes by one of these names
/// (isCalledOneOf()). With it comes `objects`, how many they are.
Arguments objectList(FrameBuilder& frame, const char* name, const std::vector<std::string>& names);

/// Likewise by the name `casters` WEDGE_CASTS for what throws a group's shadow, and WEDGE_CASTS_ELSEWHERE for what
/// throws that of another group of the light.
Arguments casterList(FrameBuilder& frame, const StyleGroup& group);

} // namespace wedge::render
