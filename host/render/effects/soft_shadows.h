#pragma once

#include "host/render/effects/term_context.h"
#include "host/render/waves.h"
#include "kernels/shared/distributed.h"
#include "kernels/shared/filter_params.h"

namespace wedge::render {

/// What the analysis of a light needs besides where pixels lie.
shared::AnalysisParams lightParams(
    shared::AnalysisParams params, const Settings& settings, const shared::AreaLight& light);

/// How a light is sampled where the pixels are the receivers. index: of the light
shared::SampleParams lightSampleParams(const Settings& settings, std::uint32_t index);

/// Directions of a pixel's lobe that no quadrature rule resolves, in proportion to its samples: whatever stood still
/// would be what the error ends at.
std::uint32_t lobeDirections(int spp);

/// Direct light of area lights, thesis chapters 3 and 5: slopes, widths and counts (kernels/shared/wedge.h), samples,
/// filter, shading. One light; each is a term of its own.
class SoftShadows {
public:
    /// What a light's term needs. specular: the scene reflects so; analysed: with filter.
    static TermShape termShape(bool specular, bool analysed);

    /// index: of the light.
    SoftShadows(const TermContext& context, Term& term, std::uint32_t index);

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
    void publishedWidths();
    void smoothedWidths();
    void narrowForHighlights(const device::Buffer<float>& beta);
    void blurShadows(const shared::DistributedParams& params);
    shared::AnalysisParams analysisParams(const image::Window& window) const;
    const shared::AreaLight& light() const { return c_.scene.areaLightList[index_]; }
    shared::SampleParams sampleParams() const;

    TermContext c_;
    Term& term_;
    std::uint32_t index_;
    bool analysed_ = false;
};

} // namespace wedge::render
