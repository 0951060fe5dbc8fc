#include "host/render/distributed_frame.h"

namespace wedge::render {

DistributedFrame::DistributedFrame(const PreparedScene& scene, const DeviceScene* deviceScene, const Settings& settings,
    std::size_t packetSize, bool keepLayers)
    : FrameGraph(settings, scene, keepLayers)
    , f_ { graph_, scene, deviceScene, settings_, PlaneLayout(settings.width, settings.height), packetSize }
    , samples_(f_, sampleShape(settings, scene, keepLayers), {})
{
    samples_.take(nullptr);
    samples_.compose();
    for (const std::unique_ptr<WaveTerm>& term : samples_.terms()) {
        widths_.push_back({ samples_.state(), term->means.beta });
    }
    Shown shown { {}, imageOf(f_.totals), samples_.taken(), {}, {}, {}, {} };
    if (keepLayers) {
        shown = { f_.surfaces, f_.totals, samples_.taken(), samples_.lensWidth(), samples_.motionWidth(),
            samples_.motion(), samples_.unfiltered() };
        shown.surfaces.emission = samples_.emission();
    }
    shown.surfaces.objectId = f_.surfaces.objectId;
    show(shown, true, f_.analysed() && settings.filtering != Filtering::None);
}

} // namespace wedge::render
