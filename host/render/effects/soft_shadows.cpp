#include "host/render/effects/soft_shadows.h"

#include "host/render/filters/widening.h"
#include "kernels/shared/light.h"
#include "kernels/shared/packed.h"
#include "kernels/shared/wedge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wedge::render {

using device::PassKind;

namespace {

float gaussianScale(float sigma)
{
    constexpr float log2e = 1.44269504f;
    return sigma > 0 ? -0.5f * log2e / (sigma * sigma) : 0.0f;
}

} // namespace

std::uint32_t lobeDirections(int spp)
{
    constexpr int usual = 256, usualSpp = 28, most = 1 << 12; // more would make launches long
    return static_cast<std::uint32_t>(std::min(most, usual * std::max(usualSpp, std::min(spp, most)) / usualSpp));
}

TermShape SoftShadows::termShape(bool specular, bool analysed)
{
    const std::uint32_t channels = specular ? 2 : 1;
    return { 2 * channels, channels, 2, analysed, false, false, false, false };
}

SoftShadows::SoftShadows(const TermContext& context, Term& term, std::uint32_t index)
    : c_(context)
    , term_(term)
    , index_(index)
{
}

shared::SampleParams lightSampleParams(const Settings& settings, std::uint32_t index)
{
    shared::SampleParams p {};
    p.shading = static_cast<std::uint32_t>(settings.shading);
    p.sampler = static_cast<std::uint32_t>(settings.sampler);
    p.light = index;
    p.firstPass = settings.method == Method::AxisAligned ? WEDGE_FIRST_PASS_RAYS : 0;
    // A filtered term is visibility of points on the light, and so is a ratio: of directions only those of lobes that
    // are narrower than the light have a part in them (met_light.h).
    const bool plain = settings.method == Method::MonteCarlo && settings.shading == Shading::Inside;
    p.lightSampling = plain ? static_cast<std::uint32_t>(settings.lightSampling) : WEDGE_LIGHTS_SAMPLED;
    return p;
}

shared::SampleParams SoftShadows::sampleParams() const
{
    shared::SampleParams p = lightSampleParams(c_.settings, index_);
    p.sampler = samplerOf(c_);
    p.firstPass = 0;
    p.strata = static_cast<std::uint32_t>(c_.settings.spp); // receivers have but some of their pixel's samples
    return p;
}

shared::AnalysisParams lightParams(shared::AnalysisParams p, const Settings& settings, const shared::AreaLight& light)
{
    p.sigma = light.sigma;
    // A_l = (2 sigma)^2, as section 3.5.1 takes the light's effective width.
    p.lightSize = 2.0f * light.sigma;
    p.k = settings.k;
    p.mu = settings.mu;
    p.alpha = settings.alpha;
    p.fillRadius = static_cast<std::uint32_t>(settings.fillRadius);
    p.fillScale = gaussianScale(settings.fillSigma);
    p.countCap = static_cast<std::uint32_t>(settings.maxSpp);
    p.fixedWidth = settings.filtering == Filtering::Fixed ? settings.fixedWidth : 0.0f;
    p.countExponent = settings.countExponent;
    p.varianceFloor = settings.varianceFloor;
    p.varianceSpread = settings.varianceSpread;
    p.lightCentre = light.centre;
    // What nine rays have missed is found in the end, however many are asked for.
    p.leastCount = std::max(WEDGE_FIRST_PASS_RAYS, static_cast<std::uint32_t>(settings.spp) / 16);
    return p;
}

shared::AnalysisParams SoftShadows::analysisParams(const image::Window& window) const
{
    return lightParams(render::analysisParams(c_, window), c_.settings, light());
}

void SoftShadows::widths()
{
    const bool spectrum = c_.settings.sampling == Sampling::Adaptive && c_.settings.counts == Counts::Spectrum;
    if (spectrum || c_.settings.slopes == Slopes::Published) {
        publishedWidths();
    }
    if (c_.settings.slopes == Slopes::Smoothed) {
        smoothedWidths();
    }
    analysed_ = true;
}

void SoftShadows::publishedWidths()
{
    const shared::AnalysisParams p = analysisParams(c_.full());
    constexpr std::uint32_t planes = 4;
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "publishedDistances", p, WEDGE_BLOCK_PIXELS,
        term_.extremes, c_.frame.position, c_.frame.objectId, c_.scratch.logs);
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "spreadRows", p, WEDGE_BLOCK_PIXELS, planes,
        c_.scratch.logs, c_.scratch.rowsSpread);
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "spreadColumns", p, WEDGE_BLOCK_PIXELS, planes,
        c_.scratch.rowsSpread, c_.scratch.spread);
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "publishedWidths", p, 1, term_.extremes,
        c_.scratch.spread, c_.frame.objectId, c_.frame.pixelSize, term_.sums, term_.beta, term_.wanted);
}

void SoftShadows::smoothedWidths()
{
    const shared::AnalysisParams p = analysisParams(c_.full());
    constexpr std::uint32_t planes = 2;
    const bool packed = c_.frame.shape.packed();
    const device::Buffer<float>& slopes = packed ? c_.scratch.slopes : term_.extremes;
    if (packed) {
        // Others had that memory, and what spreads comes from the padding, too.
        c_.scratch.logs.fill(c_.passes.queue(), 0.0f);
        c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "unpackSecond", p, 1, term_.plain, slopes);
    }
    // The plane of demands is free until the counts are made.
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "erodeSlopes", p, WEDGE_BLOCK_PIXELS, slopes,
        c_.frame.objectId, c_.scratch.demand);
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "smoothSlopes", p, WEDGE_BLOCK_PIXELS,
        c_.scratch.demand, c_.frame.objectId, c_.scratch.logs);
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "spreadRows", p, WEDGE_BLOCK_PIXELS, planes,
        c_.scratch.logs, c_.scratch.rowsSpread);
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "spreadColumns", p, WEDGE_BLOCK_PIXELS, planes,
        c_.scratch.rowsSpread, c_.scratch.spread);
    if (packed) {
        // Demands are not made yet, and slopes not eroded any more.
        c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "luminanceOf", p, 1, WEDGE_COLOUR_BITS,
            term_.texture, c_.scratch.demand);
    }
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "widths", p, 1, c_.scratch.logs, c_.scratch.spread,
        c_.frame.objectId, c_.frame.pixelSize, packed ? c_.scratch.demand : term_.sums,
        packed ? c_.scratch.width : term_.beta);
    // With shading apart from visibility samples know nothing of the lobe.
    if (c_.scene.specular && c_.settings.filtering == Filtering::Adaptive && c_.settings.shading != Shading::Separate) {
        narrowForHighlights(packed ? c_.scratch.width : term_.beta);
    }
}

void SoftShadows::narrowForHighlights(const device::Buffer<float>& beta)
{
    const shared::AnalysisParams p = analysisParams(c_.full());
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "narrowForHighlights", p, 1, c_.fullFrame, light(),
        shared::textureBits(p.packed, true), term_.texture, c_.frame.position, c_.frame.gloss, c_.frame.objectId, beta);
}

void SoftShadows::sampleWave(Waves& waves, const shared::WaveParams& wave, bool slopes, double workUnits)
{
    const shared::FrameParams receivers = waves.receiverParams(wave);
    waves.share(c_.passes, term_, wave);
    if (slopes) {
        c_.passes.tiles("first pass", PassKind::Trace, "area_light.cl", "firstPass", receivers, workUnits,
            sampleParams(), light(), waves.camera(), c_.scene.nodes, c_.scene.blocks, surfaceArguments(c_.scene),
            waves.receivers(), waves.wanted, waves.sums, waves.taken, waves.value, waves.extremes, waves.rays);
    } else {
        c_.passes.tiles("shadow rays", PassKind::Trace, "area_light.cl", "secondPass", receivers, workUnits,
            sampleParams(), light(), c_.scene.nodes, c_.scene.blocks, waves.receivers(), waves.wanted,
            std::numeric_limits<std::uint32_t>::max(), waves.sums, waves.taken, waves.value, waves.rays);
    }
    const bool exact = c_.settings.method == Method::AxisAligned && !c_.settings.distributed.published;
    if (exact) {
        c_.passes.list("unshadowed shading", PassKind::Trace, "wave_light.cl", "unshadowedReceivers",
            (wave.receivers + WEDGE_BLOCK_PIXELS - 1) / WEDGE_BLOCK_PIXELS, receivers, wave, light(),
            c_.scene.quadratures[index_], waves.pixelOf, waves.sampleOf, waves.position, waves.normal, waves.objectId,
            waves.specular, waves.gloss, waves.view, waves.unshadowed);
    }
    shared::WaveParams adding = wave;
    adding.omits |= term_.shape.omits();
    waves.pixels(c_.passes, "accumulateLight", adding, light(), exact ? 1u : 0u, waves.pixelFirst, waves.pixelCount,
        c_.frame.primaryTaken, c_.frame.hits, waves.receivers(), waves.diffuse, waves.specular, waves.sums,
        waves.unshadowed, waves.extremes, term_.accumulated(), term_.sums, c_.frame.samples);
}

void SoftShadows::publishedWidths(const shared::DistributedParams& params, const device::Buffer<float>& flags)
{
    // The light's effective half extent is two standard deviations, as in chapter 3.
    c_.passes.rows("widths", PassKind::Analysis, "published.cl", "publishedShadows", params, 1,
        c_.settings.distributed.mu, 2.0f * light().sigma, flags, term_.extremes, c_.frame.confusion, c_.frame.pixelSize,
        c_.frame.objectId, term_.beta, term_.demand);
    analysed_ = true;
}

void SoftShadows::blurShadows(const shared::DistributedParams& params)
{
    Scratch& scratch = c_.scratch;
    c_.passes.rows("filter of motion", PassKind::Filter, "distributed.cl", "shadowBlurs", params, 1, term_.extremes,
        term_.counts(), term_.beta, scratch.error, scratch.logs);
    c_.passes.rows("filter of motion", PassKind::Filter, "blur.cl", "blurMotion", params, 1, 1u, scratch.error,
        scratch.logs, scratch.filtered, scratch.rowsFiltered);
    c_.passes.rows("filter of motion", PassKind::Filter, "distributed.cl", "copyPlane", params, 1, scratch.rowsFiltered,
        scratch.filtered);
}

void SoftShadows::filterDistributed(const shared::DistributedParams& params)
{
    const device::Buffer<float>& visibility = c_.scratch.visibility;
    const shared::FilterParams filter = c_.settings.distributed.published
        ? publishedParams(c_.settings, c_.fullFrame, c_.full())
        : filterParams(c_.settings, c_.fullFrame, light(), c_.full());
    if (widens(c_.settings)) {
        widenDistributed(c_, term_, params, Widening(c_, "filter", filter, c_.settings.widening));
    }
    c_.passes.rows("filter", PassKind::Filter, "distributed.cl", "visibilityOf", params, 1, term_.texture, term_.value,
        visibility);
    gaussianFilter(c_.passes, { "filter", PassKind::Filter, "filter_variance.cl" }, filter, c_.full(), c_.frame,
        visibility, term_.beta, c_.scratch, c_.scratch.filtered);
    if (c_.scene.moves && c_.settings.distributed.blur) {
        blurShadows(params);
    }
    addFilteredTerm(c_, term_, params, c_.frame.direct);
}

} // namespace wedge::render
