#pragma once

#include "host/render/receiver_set.h"

#include <string>

namespace wedge::render {

/// Few of a frame's pixels, those in the middle of the pixels of a coarse grid, as receivers; in planes of that scale.
class CoarseReceivers : public ReceiverSet {
public:
    /// Declares the pass that copies what is known of them. frame: of pixels that are the receivers
    CoarseReceivers(FrameBuilder& frame, graph::Scale scale);

    graph::Argument frame() const override;
    const Surfaces& surfaces() const override { return surfaces_; }
    Arguments arguments() const override;
    graph::Argument sampleOf() const override { return graph::absent("sampleOf", graph::counts); }
    std::optional<std::uint32_t> samples() const override { return static_cast<std::uint32_t>(f_.settings.spp); }
    graph::Argument tallyRays() override { return graph::tallies("rays", rays_); }
    graph::Argument tallyPathRays() override;
    void trace(std::string name, graph::KernelName kernel, Arguments arguments,
        const std::function<double(const graph::Launch&)>& workUnits) override;

    graph::Scale scale() const { return scale_; }
    /// Adds what was tallied to the frame's total, after all passes that traced some.
    void countRays();
    const graph::Handle<Count>& rays() const { return rays_; }

private:
    void copy();

    FrameBuilder& f_;
    graph::Scale scale_;
    PlaneLayout layout_;
    Surfaces surfaces_;
    graph::Handle<Count> rays_;
};

} // namespace wedge::render
