#pragma once

#include "host/render/distributed_samples.h"
#include "host/render/frame_graph.h"

namespace wedge::render {

/// A frame whose pixels have several receivers, isDistributed(), of one set of samples.
class DistributedFrame : public FrameGraph {
public:
    /// As PixelFrame. keepLayers: what layers show is wanted, too, and else nothing but the beauty and what is counted.
    DistributedFrame(const PreparedScene& scene, const DeviceScene* deviceScene, const Settings& settings,
        std::size_t packetSize, bool keepLayers, FrameFilter* filter = nullptr);

private:
    FrameBuilder f_;
    DistributedSamples samples_;
};

} // namespace wedge::render
