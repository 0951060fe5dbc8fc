#pragma once

#include "host/render/effect.h"

namespace wedge::render {

/// Declares the passes that draw a soft shadow in its light's styles. Returns what is to be added to what is seen of
/// the light, as Effect::changeVisibility() has it. The light has at least one style.
graph::Handle<Value> softStyles(FrameBuilder& frame, const LightVisibility& seen);

/// Adds to the frame's layers what is seen of such a light, and metres to where that is half of it. known: in which
/// runs what is seen is known; in others the matte is unknown.
void showSoftShadow(
    FrameBuilder& frame, const LightVisibility& seen, const std::function<bool(const graph::Run&)>& known);

} // namespace wedge::render
