#include "host/render/effects/soft_shadows.h"

#include "host/render/filters/widening.h"
#include "host/render/sample_counts.h"
#include "kernels/shared/light.h"
#include "kernels/shared/packed.h"
#include "kernels/shared/wedge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wedge::render {

using device::PassKind;

namespace {

// Samples of a pixel between two looks at the cancel flag; also what one launch over one tile may cost.
constexpr std::uint32_t monteCarloSlice = 64;
constexpr std::uint32_t secondPassSlice = 256;

float gaussianScale(float sigma)
{
    constexpr float log2e = 1.44269504f;
    return sigma > 0 ? -0.5f * log2e / (sigma * sigma) : 0.0f;
}

/// Directions of a pixel's lobe that no quadrature rule resolves, in proportion to its samples: whatever stood still
/// would be what the error ends at.
std::uint32_t lobeDirections(int spp)
{
    constexpr int usual = 256, usualSpp = 28, most = 1 << 12; // more would make launches long
    return static_cast<std::uint32_t>(std::min(most, usual * std::max(usualSpp, std::min(spp, most)) / usualSpp));
}

} // namespace

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

bool SoftShadows::render()
{
    term_.clear(c_.passes.queue());
    const bool complete = sample();
    if (analysed_ && c_.settings.filtering != Filtering::None) {
        const shared::FilterParams params = filterParams(c_.settings, c_.fullFrame, light(), c_.window);
        // What was stopped early has not the counts that the parts of samples were made for.
        if (complete && widens(c_.settings)) {
            widen(params);
        }
        gaussianFilter(c_.passes, { "filter", PassKind::Filter, "filter.cl" }, params, c_.window, c_.frame, term_.value,
            term_.beta, c_.scratch, c_.scratch.filtered);
        shade(c_.scratch.filtered);
    } else {
        shade(term_.value);
    }
    return complete;
}

void SoftShadows::widen(const shared::FilterParams& params)
{
    Scratch& scratch = c_.scratch;
    c_.passes.rows("filter", PassKind::Filter, "widen.cl", "oneOfLight", analysisParams(c_.full()), WEDGE_BLOCK_PIXELS,
        WEDGE_FIRST_PASS_RAYS, term_.value, term_.taken, term_.sums, c_.frame.diffuse, c_.frame.specular,
        scratch.visibility, scratch.deviation, scratch.weights);
    const Widening widening(c_, "filter", params, c_.settings.widening);
    widening.compare(scratch.visibility, scratch.deviation, term_.beta);
    widening.apply(scratch.visibility, scratch.deviation, scratch.weights, term_.beta);
}

bool SoftShadows::sample()
{
    const auto spp = static_cast<std::uint32_t>(c_.settings.spp);
    if (c_.settings.method == Method::MonteCarlo) {
        uniformCounts(c_.passes, analysisParams(blockWindow(c_.window, 0, c_.full().x1, c_.full().y1)), spp,
            c_.frame.objectId, term_.wanted);
        return secondPass(0);
    }
    // All of the frame even for a crop: the counts' scale comes from all pixels, and a crop is to be the same pixels as
    // the whole image.
    uniformCounts(c_.passes, analysisParams(c_.full()), WEDGE_FIRST_PASS_RAYS, c_.frame.objectId, term_.wanted);
    if (!firstPass()) {
        return false;
    }
    widthsAndCounts();
    return secondPass(WEDGE_FIRST_PASS_RAYS);
}

shared::SampleParams SoftShadows::sampleParams() const
{
    shared::SampleParams p {};
    p.shading = static_cast<std::uint32_t>(c_.settings.shading);
    p.sampler = samplerOf(c_);
    p.light = index_;
    p.firstPass = c_.settings.method == Method::AxisAligned && !c_.frame.distributed ? WEDGE_FIRST_PASS_RAYS : 0;
    p.lightSampling = lightSampling();
    // Of a distributed frame's receivers each has but some of its pixel's samples.
    p.strata = c_.frame.distributed ? static_cast<std::uint32_t>(c_.settings.spp) : 0;
    return p;
}

std::uint32_t SoftShadows::lightSampling() const
{
    // A filtered term is visibility of points on the light, and so is a ratio: of directions only those of lobes that
    // are narrower than the light have a part in them (met_light.h).
    const bool plain = c_.settings.method == Method::MonteCarlo && c_.settings.shading == Shading::Inside;
    return plain ? static_cast<std::uint32_t>(c_.settings.lightSampling) : WEDGE_LIGHTS_SAMPLED;
}

bool SoftShadows::firstPass()
{
    try {
        c_.passes.tiles("first pass", PassKind::Trace, "area_light.cl", "firstPass", c_.fullFrame,
            WEDGE_FIRST_PASS_RAYS, sampleParams(), light(), shared::CameraParams {}, c_.scene.nodes, c_.scene.blocks,
            surfaceArguments(c_.scene), c_.frame.receivers(), term_.wanted, term_.sums, term_.taken, term_.value,
            term_.extremes, c_.frame.rays);
    } catch (const device::Cancelled&) {
        return false;
    }
    return true;
}

bool SoftShadows::secondPass(std::uint32_t from)
{
    const bool plain = c_.settings.method == Method::MonteCarlo;
    const std::uint32_t slice = plain ? monteCarloSlice : secondPassSlice;
    const std::uint32_t most = static_cast<std::uint32_t>(
        c_.settings.sampling == Sampling::Uniform ? c_.settings.spp : std::max(c_.settings.maxSpp, c_.settings.spp));
    const double units = std::max(1.0, static_cast<double>(c_.settings.spp) - from);
    try {
        for (std::uint32_t last = from; last < most;) {
            // Most pixels are done at twice the mean; the slices up to the cap count for what little is left.
            const double knee = std::min<double>(most, std::max(2.0 * c_.settings.spp, from + 1.0));
            const auto done = [&](double n) {
                return 0.9 * std::min(n - from, knee - from) / (knee - from) + 0.1 * (n - from) / (most - from);
            };
            const double share = done(std::min(last + slice, most)) - done(last);
            last += std::min(slice, most - last);
            c_.passes.tiles(plain ? "shadow rays" : "second pass", PassKind::Trace, "area_light.cl", "secondPass",
                c_.sampledFrame, units * share, sampleParams(), light(), c_.scene.nodes, c_.scene.blocks,
                c_.frame.receivers(), term_.wanted, last, term_.sums, term_.taken, term_.value, c_.frame.rays);
            if (c_.passes.rehearsal()) {
                break;
            }
        }
    } catch (const device::Cancelled&) {
        return false;
    }
    return true;
}

shared::AnalysisParams SoftShadows::analysisParams(const image::Window& window) const
{
    shared::AnalysisParams p = render::analysisParams(c_, window);
    p.sigma = light().sigma;
    // A_l = (2 sigma)^2, as section 3.5.1 takes the light's effective width.
    p.lightSize = 2.0f * light().sigma;
    p.k = c_.settings.k;
    p.mu = c_.settings.mu;
    p.alpha = c_.settings.alpha;
    p.fillRadius = static_cast<std::uint32_t>(c_.settings.fillRadius);
    p.fillScale = gaussianScale(c_.settings.fillSigma);
    p.countCap = static_cast<std::uint32_t>(c_.settings.maxSpp);
    p.fixedWidth = c_.settings.filtering == Filtering::Fixed ? c_.settings.fixedWidth : 0.0f;
    p.countExponent = c_.settings.countExponent;
    p.varianceFloor = c_.settings.varianceFloor;
    p.varianceSpread = c_.settings.varianceSpread;
    p.lightCentre = light().centre;
    // What nine rays have missed is found in the end, however many are asked for.
    p.leastCount = std::max(WEDGE_FIRST_PASS_RAYS, static_cast<std::uint32_t>(c_.settings.spp) / 16);
    return p;
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

void SoftShadows::widthsAndCounts()
{
    widths();
    if (c_.settings.sampling == Sampling::Uniform) {
        uniformCounts(c_.passes, analysisParams(c_.full()), static_cast<std::uint32_t>(c_.settings.spp),
            c_.frame.objectId, term_.wanted);
    } else if (c_.settings.counts == Counts::Variance) {
        countsFromVariance();
    }
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
    if (!c_.frame.distributed) {
        c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "narrowForLobes", p, 1, c_.fullFrame, term_.sums,
            c_.frame.position, c_.frame.gloss, c_.frame.diffuse, c_.frame.specular, beta);
        return;
    }
    c_.passes.rows("widths", PassKind::Analysis, "analysis.cl", "narrowForHighlights", p, 1, c_.fullFrame, light(),
        shared::textureBits(p.packed, true), term_.texture, c_.frame.position, c_.frame.gloss, c_.frame.objectId, beta);
}

void SoftShadows::countsFromVariance()
{
    const shared::AnalysisParams p = analysisParams(c_.full());
    if (c_.settings.filtering == Filtering::None) {
        c_.scratch.effective.fill(c_.passes.queue(), 1.0f);
    } else {
        gaussianFilter(c_.passes, { "filter of first pass", PassKind::Analysis, "filter.cl" },
            filterParams(c_.settings, c_.fullFrame, light(), c_.full()), c_.full(), c_.frame, term_.value, term_.beta,
            c_.scratch, c_.scratch.filtered);
    }
    const device::Buffer<float>& visibility =
        c_.settings.filtering == Filtering::None ? term_.value : c_.scratch.filtered;
    c_.passes.rows("counts", PassKind::Analysis, "counts.cl", "countDemand", p, WEDGE_BLOCK_PIXELS, visibility,
        c_.scratch.effective, term_.beta, c_.frame.objectId, c_.scratch.demand);
    countsFromDemand(c_.passes, p, static_cast<float>(c_.settings.spp), c_.frame.objectId, c_.scratch, term_.wanted);
}

void SoftShadows::shade(const device::Buffer<float>& value)
{
    const image::Window window = blockWindow(c_.window, 0, c_.full().x1, c_.full().y1);
    const shared::AnalysisParams p = analysisParams(window);
    c_.passes.rows("composite", PassKind::Composite, "composite.cl", "addDiffuse", p, WEDGE_BLOCK_PIXELS,
        sampleParams(), light(), c_.scene.quadratures[index_], c_.frame.position, c_.frame.normal, c_.frame.objectId,
        c_.frame.diffuse, value, term_.value, term_.taken, c_.frame.direct, c_.frame.directNoisy,
        c_.frame.directDeviation, c_.frame.samples);
    if (c_.scene.specular) {
        c_.passes.rows("composite", PassKind::Composite, "composite.cl", "addSpecular", p, WEDGE_BLOCK_PIXELS,
            sampleParams(), light(), c_.fullFrame, lobeDirections(c_.settings.spp), c_.scene.quadratures[index_],
            c_.frame.position, c_.frame.normal, c_.frame.objectId, c_.frame.gloss, c_.frame.specular, value,
            term_.value, term_.taken, c_.frame.direct, c_.frame.directNoisy, c_.frame.directDeviation);
    }
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
