// Passes that filters of samples have alike, whether samples are stored one by one (stored_samples.h) or by their
// brightness (sample_bins.h).
#pragma once

#include "host/render/frame_builder.h"

namespace wedge::render {

/// What reports call passes that go over samples.
inline constexpr const char* samplePass = "filters of samples";

/// Declares how many samples of each pixel the exposure is found of: of one pixel among WEDGE_PROBE_STEP^2, on a
/// surface where objectId is known, else of whatever.
graph::Handle<Count> probeCounts(FrameBuilder& frame, const graph::Handle<ObjectId>& objectId);

/// Declares how the exposure follows from what samples of those pixels add up to.
void exposureOfProbes(FrameBuilder& frame, const graph::Handle<Sums>& sums, const graph::Handle<Count>& taken,
    graph::Handle<Share>& exposure);

/// What means lose to a filter of samples, and whose they are.
struct LostLight {
    graph::Handle<Radiance> excess; ///< of a sample
    graph::Handle<Count> taken; ///< samples of a pixel; 0 where the term is not
    graph::Handle<Sums>& sums; ///< of what is kept, which gain what others lose
    graph::Handle<Value>& parts; ///< means of a part of those; of no graph: there are none
};

/// Declares that what pixels lose goes to others of their surface, by a Gaussian of sigma pixels; 0: it is lost. Its
/// width grows by doubling up to `widest` where a pixel would get much of it back; less than 2 sigma: it does not.
void spread(FrameBuilder& frame, float sigma, float widest, LostLight lost);

/// Declares the means of what is kept, in whatever format of colours.
void meansOfKept(FrameBuilder& frame, const graph::Handle<Sums>& sums, const graph::Handle<Count>& taken,
    graph::Handle<Value>& mean);

} // namespace wedge::render
