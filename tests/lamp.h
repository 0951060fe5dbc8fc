// An area light for tests of shading kernels, and the rule that they integrate over it by.
#pragma once

#include "host/render/quadrature.h"
#include "host/scene/scene.h"
#include "kernels/shared/light.h"

#include <vector>

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

/// Nodes and weights of the coarse and of the fine rule, as kernels take them.
inline std::vector<float> nodesOf(const scene::AreaLight& light)
{
    std::vector<float> out;
    for (const unsigned count : { WEDGE_COARSE_NODES, WEDGE_FINE_NODES })
        for (const render::Node& node : render::profileRule(light.profile, light.cut, static_cast<int>(count))) {
            out.push_back(static_cast<float>(node.position));
            out.push_back(static_cast<float>(node.weight));
        }
    return out;
}

} // namespace wedge::test
