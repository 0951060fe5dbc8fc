// The effects, in the order in which frames have them: one line each.
#include "effects/area_lights/area_lights.h"
#include "effects/delta_lights/delta_lights.h"
#include "effects/emitters/emitters.h"
#include "effects/environment/environment.h"
#include "effects/indirect/indirect_light.h"
#include "effects/mirrors/mirrors.h"
#include "effects/shadow_lights/shadow_lights.h"
#include "effects/styled_shadows/styled_shadows.h"

namespace wedge::render {
namespace {

const Registration ofAreaLights(areaLights());
const Registration ofDeltaLights(deltaLights());
const Registration ofStyledShadows(styledShadows());
const Registration ofEmitters(emitters());
const Registration ofEnvironment(environment());
const Registration ofShadowLights(shadowLights());
const Registration ofIndirectLight(indirectLight());
const Registration ofMirrors(mirrors());

} // namespace
} // namespace wedge::render
