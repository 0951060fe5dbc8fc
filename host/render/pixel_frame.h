#pragma once

#include "host/render/effect.h"
#include "host/render/frame_graph.h"

#include <vector>

namespace wedge::render {

/// A frame whose pixels are the receivers of light, through a pinhole, with nothing that moves.
class PixelFrame : public FrameGraph {
public:
    /// deviceScene: null for a graph that is planned and not run.
    /// keepLayers: what layers show is wanted, too. filter: what is done to the frame; null: nothing.
    PixelFrame(const PreparedScene& scene, const DeviceScene* deviceScene, const Settings& settings,
        std::size_t packetSize, bool keepLayers, FrameFilter* filter = nullptr);

private:
    void primary(bool lit);
    /// Terms of the one part, of all those of the frame.
    void addTerms(Part part);
    void addUnfiltered(const Unfiltered& added);
    /// Adds to direct light what may change when the frame is run again: in the place of its planes others are used
    /// from here on, so that those stay as they are.
    void addChanging(const graph::Handle<Radiance>& radiance);
    /// out = below + what surfaces reflect, which, where it fallsBack, falls back to the pixel's own samples. Where the
    /// light is read apart the sum becomes that.
    void addReflected(const graph::Handle<Radiance>& below, Sum& sum, bool fallsBack, graph::Handle<Radiance>& out);
    void show();

    bool apart_; ///< light is read apart, as SampleShape has it
    FrameBuilder f_;
};

} // namespace wedge::render
