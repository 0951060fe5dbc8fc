// An area light for tests of shading kernels.
#pragma once

#include "host/scene/scene.h"

namespace wedge::test {

/// Above the origin, slanted and longer than wide: half extents of 0.41 and 0.6 m.
inline scene::AreaLight lamp(scene::LightProfile profile, bool twoSided)
{
    scene::AreaLight light;
    light.centre = { 0.2f, 2, -0.1f };
    light.halfU = { 0.4f, 0.1f, 0 };
    light.halfV = { 0, 0, 0.6f };
    light.radiance = { 5, 4, 3 };
    light.profile = profile;
    light.twoSided = twoSided;
    return light;
}

} // namespace wedge::test
