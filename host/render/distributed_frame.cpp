#include "host/render/distributed_frame.h"

#include "host/render/frame_filter.h"

namespace wedge::render {

DistributedFrame::DistributedFrame(const PreparedScene& scene, const DeviceScene* deviceScene, const Settings& settings,
    std::size_t packetSize, bool keepLayers, FrameFilter* filter)
    : FrameGraph(settings, scene, keepLayers, true)
    , f_ { graph_, scene, deviceScene, settings_, layout_, packetSize }
    , samples_(f_, sampleShape(settings, scene, keepLayers, filter != nullptr), {})
{
    samples_.take(nullptr);
    samples_.compose();
    if (filter != nullptr) {
        filter->declare(f_);
    }
    samples_.show(outputs_);
    if (keepLayers) {
        showWidths(f_, samples_, f_.surfaces.pixelSize);
    }
    finish(f_);
}

} // namespace wedge::render
