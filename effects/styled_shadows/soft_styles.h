#pragma once

#include "host/render/effect.h"

namespace wedge::render {

/// Declares the passes that draw a soft shadow in its light's styles. Returns what is to be added to what is seen of
/// the light, as Effect::changeSeen() has it. The light has at least one style.
graph::Handle<Value> softStyles(FrameBuilder& frame, const SeenLight& seen);

} // namespace wedge::render
