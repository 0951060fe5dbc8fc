#pragma once

#include "host/render/device_scene.h"
#include "host/render/frame.h"
#include "host/render/passes.h"
#include "host/render/settings.h"
#include "kernels/shared/distributed.h"
#include "kernels/shared/filter_params.h"

namespace wedge::render {

/// What every effect of a frame works with; all of it outlives the effects.
struct TermContext {
    Passes& passes;
    const DeviceScene& scene;
    Frame& frame;
    Scratch& scratch;
    const Settings& settings;
    shared::FrameParams fullFrame; ///< of the whole image
    shared::FrameParams sampledFrame; ///< of the pixels that need their last samples
    image::Window window; ///< the pixels that the result is wanted for
    bool shutter; ///< something moves while it is open

    image::Window full() const
    {
        return { 0, 0, static_cast<int>(frame.layout.width), static_cast<int>(frame.layout.height) };
    }
};

/// Where kernels of analysis find the pixels of `window`; all else is 0.
shared::AnalysisParams analysisParams(const TermContext& context, const image::Window& window);

/// WEDGE_SAMPLER_* of the frame. Strata are for counts that are known before the first sample is taken, and distributed
/// frames with counts of their own a pixel, and progressive ones, take a sequence in their place.
std::uint32_t samplerOf(const TermContext& context);

/// In a distributed frame, adds a term to a radiance: with its filtered value, scratch.filtered, where it has one.
void addFilteredTerm(const TermContext& context, const Term& term, const shared::DistributedParams& params,
    device::Buffer<float>& radiance);

} // namespace wedge::render
