#pragma once

#include "host/render/settings.h"

namespace wedge::render {

/// Whether narrow filters of lights and of indirect light are compared with wider ones, and widened where nothing
/// speaks for them. Not where samples know nothing of what their light is worth in the image.
bool widens(const Settings& settings);

/// Pixels over which filters that are compared reach; a width covers more of them where surfaces are seen at a slant.
int comparedReach(const Settings& settings, float pixels);

// How much of the samples' variance counts. It is known from two parts of a sequence, whose points complement each
// other as long as nothing else is drawn with them: then it comes out too large.
constexpr float pinholeNoise = 0.5f, distributedNoise = 0.6f;

} // namespace wedge::render
