#pragma once

#include "host/render/filter_chain.h"
#include "host/render/frame_builder.h"

namespace wedge::render {

struct TermMeans;

/// A term's samples of a frame whose pixels have several receivers, by their brightness (kernels/sinks/sample_bins.h),
/// for a filter of samples. A receiver's samples are one. Memory is that of a plane, however many samples there are;
/// what is kept is that of all, in whatever steps they come.
class SampleBins {
public:
    /// bins, exposure: where they are, from step to step; empty and unknown before the first.
    SampleBins(
        FrameBuilder& frame, ChosenSampleFilter chosen, graph::Handle<Packed> bins, graph::Handle<Share> exposure);

    /// Declares the exposure that the filter's values give. False where it is asked for: then it is to be probed.
    bool givesExposure();
    void expose(const graph::Handle<Sums>& ofProbes, const graph::Handle<Count>& takenByProbes);

    /// What receivers are added to: `bins`, `exposure` and the frame's `notFinite`; and their places in passes of terms
    /// without bins.
    Arguments sunk();
    static Arguments notSunk();

    /// Declares means of what is kept of all samples so far: value, deviation and mean squares; the rest is `all`'s,
    /// which stay as they are. layers: rejected() and density() are wanted.
    TermMeans kept(const TermMeans& all, bool layers);

    /// Of the last kept() with layers: what means lose, and mean isolations; of no graph: the filter measures none.
    const graph::Handle<Radiance>& rejected() const { return rejected_; }
    const graph::Handle<Share>& density() const { return density_; }

private:
    FrameBuilder& frame_;
    ChosenSampleFilter chosen_;
    graph::Handle<Packed> bins_;
    graph::Handle<Share> exposure_;
    graph::Handle<Radiance> rejected_;
    graph::Handle<Share> density_;
};

} // namespace wedge::render
