#pragma once

#include "host/render/receiver_set.h"

#include <cstdint>

namespace wedge::render {

/// What lights that stand for a map bring to receivers: six planes each of matt light and of lobes', shadowed and
/// unshadowed, R G B; of lobes six more of wider ones where widensLobes(). And how many of the lights that is of.
struct LightSums {
    graph::Handle<Sums> matt, lobes;
    graph::Handle<Count> taken;
};

/// Whether there are sums of lobes that are at least as wide as lights are apart.
bool widensLobes(const ShadowSettings& settings);

/// The sums of lobes, or that there are none; name: in the kernel
graph::Argument readsLobes(const char* name, const FrameBuilder& frame, const LightSums& sums);

/// Declares the passes that trace rays to the lights of the frame's map, and find what they bring to each pixel.
LightSums lightSums(FrameBuilder& frame, ReceiverSet& at);
/// Units of work of these, of a frame's progress.
double lightUnits(const ShadowSettings& settings);

} // namespace wedge::render
