#include "effects/indirect/path_term.h"

#include "effects/indirect/path_graph.h"
#include "effects/indirect/path_waves.h"

namespace wedge::render {

Term directPathTerm(Component component, const char* name, const Settings& settings)
{
    return { .name = name,
        .part = Part::Direct,
        .workUnits = static_cast<double>(settings.spp),
        .gathersVariance = true,
        .ofLobes = isGlossy(component),
        .ofPixels = [component](FrameBuilder& frame, const std::shared_ptr<TermState>& state,
                        graph::Handle<Metres>& beta) { addPaths(frame, component, state, beta); },
        .ofWaves = [component](FrameBuilder& frame,
                       const SampleShape& shape) { return std::make_unique<PathWaves>(frame, shape, component); } };
}

} // namespace wedge::render
