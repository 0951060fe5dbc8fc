#pragma once

#include "host/render/frame_builder.h"

#include <optional>
#include <vector>

namespace wedge::render {

/// One kind of samples that a frame's pixels are to have.
struct AskedSamples {
    graph::Handle<Demand> demand;
    float rays; ///< of a sample; 1 of the first kind
    float least; ///< samples of a pixel
    graph::Handle<Count>* wanted; ///< what comes of it: of each pixel, all of its samples
    std::optional<graph::Version> taken = {}; ///< samples that there are, which no count goes below; none: 0
    /// Variance of a sample's ray, of the pixel's own samples (demand.cl); where there is any, counts of the first kind
    /// may become even. All kinds have it, or none.
    std::optional<graph::Handle<Uncertainty>> uncertainty = {};
};

/// What all kinds together have.
struct CountScale {
    float rays; ///< a pixel that takes samples, in the mean
    float most; ///< samples of any kind and pixel
    std::optional<graph::Version> mask = {}; ///< pixels where it is 0 take none; without, all take some
};

/// Declares how counts follow from demands: clamp(C demand, least, most), with one C for all kinds such that their rays
/// are what is asked for (kernels/analysis/counts.cl).
void countsFromDemands(FrameBuilder& frame, const std::vector<AskedSamples>& kinds, const CountScale& scale);

/// The same count for all pixels of the mask.
void uniformCounts(FrameBuilder& frame, std::uint32_t count, const graph::Version& mask, graph::Handle<Count>& wanted);

} // namespace wedge::render
