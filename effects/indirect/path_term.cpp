#include "effects/indirect/path_term.h"

#include "effects/indirect/path_pixels.h"
#include "effects/indirect/path_waves.h"

#include <algorithm>

namespace wedge::render {

Term pathTerm(Component component, const char* name, const Settings& settings)
{
    const bool direct = isDirect(component);
    return { .name = name,
        .target = targetOf(component).name,
        .part = direct ? Part::Direct : Part::Indirect,
        .workUnits = static_cast<double>(settings.spp) * (direct ? 1 : std::max(1, settings.bounces)),
        .gathersVariance = true,
        .ofLobes = isGlossy(component),
        .inPixels = [component](FrameBuilder& frame) { return std::make_unique<PathPixels>(frame, component); },
        .inWaves = [component](FrameBuilder& frame,
                       const SampleShape& shape) { return std::make_unique<PathWaves>(frame, shape, component); } };
}

} // namespace wedge::render
