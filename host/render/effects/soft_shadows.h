#pragma once

#include "host/render/effects/term_context.h"
#include "host/render/waves.h"
#include "kernels/shared/distributed.h"
#include "kernels/shared/filter_params.h"

namespace wedge::render {

/// Direct light of area lights, thesis chapters 3 and 5: slopes, widths and counts (kernels/shared/wedge.h), samples,
/// filter, shading. One light; each is a term of its own.
class SoftShadows {
public:
    /// What a light's term needs. specular: the scene reflects so; analysed: with filter.
    static TermShape termShape(bool specular, bool analysed);

    /// index: of the light.
    SoftShadows(const TermContext& context, Term& term, std::uint32_t index);

    /// The pixels being the receivers: samples, filters and adds the light to frame.direct and directNoisy. Returns
    /// false if cancelled while sampling; what was sampled until then is filtered and added all the same.
    bool render();

    /// In a distributed frame: the samples of a wave's receivers, added to their pixels. slopes: also measures those.
    void sampleWave(Waves& waves, const shared::WaveParams& wave, bool slopes, double workUnits);
    /// After a first pass of slopes: term.beta, metres.
    void widths();
    /// The same as published (5.18), and term.demand by (5.25), (5.27); flags: 1 where the factors are taken apart.
    void publishedWidths(const shared::DistributedParams& params, const device::Buffer<float>& flags);
    /// Adds the term to frame.direct: filtered where it is taken apart from its texture.
    void filterDistributed(const shared::DistributedParams& params);

    /// Whether the light got widths: not so in plain Monte Carlo, nor if its first pass was cancelled.
    bool analysed() const { return analysed_; }

private:
    bool sample();
    bool firstPass();
    bool secondPass(std::uint32_t from);
    void widthsAndCounts();
    void publishedWidths();
    void smoothedWidths();
    void narrowForHighlights(const device::Buffer<float>& beta);
    void countsFromVariance();
    void widen(const shared::FilterParams& params);
    void blurShadows(const shared::DistributedParams& params);
    void shade(const device::Buffer<float>& value);
    shared::AnalysisParams analysisParams(const image::Window& window) const;
    const shared::AreaLight& light() const { return c_.scene.areaLightList[index_]; }
    shared::SampleParams sampleParams() const;
    std::uint32_t lightSampling() const;

    TermContext c_;
    Term& term_;
    std::uint32_t index_;
    bool analysed_ = false;
};

} // namespace wedge::render
