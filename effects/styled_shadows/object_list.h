#pragma once

#include "host/render/frame_builder.h"

#include <string>
#include <vector>

namespace wedge::render {

/// A list, by that name, of 1 or 0 for each object's id and for 0: whether it goes by one of these names
/// (isCalledOneOf()). With it comes `objects`, how many they are.
Arguments objectList(FrameBuilder& frame, const char* name, const std::vector<std::string>& names);

} // namespace wedge::render
